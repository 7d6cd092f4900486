#!/usr/bin/env python3
"""Draws the steps of building a tree: a jaw as mesh, as voxels of two sizes, and as the spheres of one level.

    scripts/draw_tree.py PATH/TO/ist OUTPUT.png

The command makes the built-in lower jaw, its trees and their exports. The script needs Debian's python3-matplotlib, so run it with the
system's python3.
"""
import pathlib
import sys
import tempfile

import numpy as np

from pictures.drawing import Command, DepthBuffer, eye_axes, normals_of, plt, positions, read_ply, read_stl, save_small_png

PIXELS = 900
MARGIN = 4  # mm
VIEW = eye_axes(np.array([-0.62, -0.92, 0.62]))
LIGHT = np.array([-0.25, -0.55, 0.85])
LEVEL = 2
SKIN, CUBE, BALL = (0.93, 0.88, 0.78), (0.72, 0.82, 0.93), (0.80, 0.90, 0.74)


class Canvas:
    """A square picture that holds all points of a body."""

    def __init__(self, points):
        seen = points @ VIEW.T
        self.scale = PIXELS / (np.ptp(seen, axis=0)[:2].max() + 2 * MARGIN)
        self.centre = (seen.min(0) + seen.max(0)) / 2 * self.scale - (PIXELS / 2, PIXELS / 2, 0)
        self.buffer = DepthBuffer(PIXELS, PIXELS)

    def place(self, points):
        return points @ VIEW.T * self.scale - self.centre

    def triangles(self, triangles, colour):
        """Returns the image of triangles."""
        self.buffer.draw(self.place(triangles.reshape(-1, 3)), np.arange(3 * len(triangles)).reshape(-1, 3))
        return self.lit(colour, lambda samples: normals_of(triangles)[self.buffer.nearest[samples]])

    def balls(self, balls, colour):
        """Returns the image of balls, a row each: the centre and the radius."""
        centres, radii = self.place(balls[:, :3]), balls[:, 3] * self.scale
        self.buffer.draw_balls(np.column_stack([centres, radii]))

        def normals(samples):
            y, x = np.divmod(samples, PIXELS)
            ball = self.buffer.nearest[samples]
            return (np.column_stack([x + 0.5, y + 0.5, self.buffer.depth[samples]]) - centres[ball]) / radii[ball, None] @ VIEW
        return self.lit(colour, normals)

    def lit(self, colour, normals_at):
        seen = np.flatnonzero(self.buffer.nearest >= 0)
        lit = 0.30 + 0.70 * np.clip(normals_at(seen) @ LIGHT / np.linalg.norm(LIGHT), 0, 1) ** 0.9
        depth = self.buffer.depth[seen]
        fog = 0.80 + 0.20 * (depth - depth.min()) / np.ptp(depth)
        image = np.ones((PIXELS * PIXELS, 3))
        image[seen] = (lit * fog)[:, None] * colour
        return image.reshape(PIXELS, PIXELS, 3)


def main(ist, output):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        command = Command(pathlib.Path(ist).resolve(), folder)
        mesh = read_stl(command.mesh("lower"))
        panels = [(f"mesh, {len(mesh):,} triangles", Canvas.triangles, mesh, SKIN)]
        for size in (4, 1):
            tree, file = command.tree("lower", voxel_size=size), folder / f"{size}.ply"
            count = command.answer("export", tree, "--what", "voxels", "--level", 0, "-o", file)["count"]
            vertices, faces = read_ply(file)
            quads = positions(vertices)[faces]
            panels.append((f"voxels of {size} mm, {count:,}", Canvas.triangles, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]), CUBE))
        for policy in ("simple", "table", "tight"):
            balls = command.spheres(tree, policy, LEVEL)
            volume = 4 / 3 * np.pi * (balls[:, 3] ** 3).sum() / 1000
            panels.append((f"{policy}: {len(balls):,} spheres of level {LEVEL}, {volume:,.0f} cm³", Canvas.balls, balls, BALL))
        figure, places = plt.subplots(2, 3, figsize=(13.2, 8.9))
        for place, (title, draw, shapes, colour) in zip(places.flat, panels):
            place.imshow(draw(Canvas(mesh.reshape(-1, 3)), shapes, colour), origin="lower", interpolation="antialiased")
            place.set_title(title, fontsize=12)
            place.axis("off")
        figure.tight_layout()
        save_small_png(figure, output)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
