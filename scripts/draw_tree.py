#!/usr/bin/env python3
"""Draws how a tree is made: a jaw as mesh, as voxels of two sizes, and as the spheres of one level.

    scripts/draw_tree.py PATH/TO/ist OUTPUT.png

All that is drawn comes from the command: the built-in lower jaw, its trees, and their exports. Needs Debian's
python3-matplotlib, so run it with the system's python3.
"""
import pathlib
import sys
import tempfile

import numpy as np

from pictures.drawing import Command, plt, positions, read_ply, read_stl, save_small_png

PIXELS = 900
VIEW_FROM = np.array([-0.62, -0.92, 0.62])
LIGHT = np.array([-0.25, -0.55, 0.85])
LEVEL = 2


class Canvas:
    """A depth buffer seen along VIEW_FROM; normals are kept and lit at the end."""

    def __init__(self, points, margin):
        back = VIEW_FROM / np.linalg.norm(VIEW_FROM)
        right = np.cross([0, 0, 1], back)
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(back, right), back])
        seen = points @ self.axes.T
        self.centre = (seen.min(0) + seen.max(0)) / 2
        self.scale = PIXELS / (np.ptp(seen, axis=0)[:2].max() + 2 * margin)
        self.depth = np.full((PIXELS, PIXELS), -np.inf)
        self.normals = np.zeros((PIXELS, PIXELS, 3))

    def project(self, points):
        seen = points @ self.axes.T - self.centre
        seen[..., :2] = seen[..., :2] * self.scale + PIXELS / 2
        return seen

    def splat(self, points, normals):
        x, y = np.floor(points[:, 0]).astype(int), np.floor(points[:, 1]).astype(int)
        inside = (x >= 0) & (x < PIXELS) & (y >= 0) & (y < PIXELS)
        x, y, z, normals = x[inside], y[inside], points[inside, 2], normals[inside]
        order = np.argsort(z, kind="stable")
        x, y, z, normals = x[order], y[order], z[order], normals[order]
        nearer = z > self.depth[y, x]
        self.depth[y[nearer], x[nearer]] = z[nearer]
        self.normals[y[nearer], x[nearer]] = normals[nearer]

    def add_triangles(self, triangles):
        normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
        facing = normals @ self.axes[2] > 0
        triangles, normals = triangles[facing], normals[facing]
        seen = self.project(triangles)
        size = np.ceil(2 * np.ptp(seen[:, :, :2], axis=1).max(1)).astype(int) + 1
        for steps in np.unique(size):
            chosen = size == steps
            u, v = np.meshgrid(*2 * [np.linspace(0, 1, steps + 1)])
            u, v = (grid[u + v <= 1 + 1e-9] for grid in (u, v))
            weights = np.stack([1 - u - v, u, v], axis=1)
            for part in np.array_split(np.flatnonzero(chosen), max(1, chosen.sum() * len(u) // 2_000_000)):
                points = np.einsum("sk,tkc->tsc", weights, seen[part]).reshape(-1, 3)
                self.splat(points, np.repeat(normals[part], len(u), axis=0))

    def add_spheres(self, spheres):
        for centre, radius in zip(self.project(spheres[:, :3]), spheres[:, 3]):
            reach = radius * self.scale
            x0, x1 = max(0, int(centre[0] - reach)), min(PIXELS, int(centre[0] + reach) + 2)
            y0, y1 = max(0, int(centre[1] - reach)), min(PIXELS, int(centre[1] + reach) + 2)
            x, y = np.meshgrid(np.arange(x0, x1) + 0.5, np.arange(y0, y1) + 0.5)
            u, v = (x - centre[0]) / reach, (y - centre[1]) / reach
            w2 = 1 - u * u - v * v
            w = np.sqrt(np.maximum(w2, 0))
            z = centre[2] + w * radius
            nearer = (w2 > 0) & (z > self.depth[y0:y1, x0:x1])
            self.depth[y0:y1, x0:x1][nearer] = z[nearer]
            local = np.stack([u, v, w], axis=-1) @ self.axes
            self.normals[y0:y1, x0:x1][nearer] = local[nearer]

    def image(self, colour):
        light = LIGHT / np.linalg.norm(LIGHT)
        lit = 0.30 + 0.70 * np.clip(self.normals @ light, 0, 1) ** 0.9
        finite = np.isfinite(self.depth)
        near, far = self.depth[finite].max(), self.depth[finite].min()
        fog = 0.80 + 0.20 * (np.where(finite, self.depth, near) - far) / max(near - far, 1e-9)
        image = np.ones((PIXELS, PIXELS, 3))
        image[finite] = ((lit * fog)[..., None] * np.array(colour))[finite]
        return np.clip(image, 0, 1)[::-1]


def main(ist, output):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        command = Command(pathlib.Path(ist).resolve(), folder)
        trees = {size: command.tree("lower", voxel_size=size) for size in (4, 1)}
        voxels = {size: command.answer("export", tree, "--what", "voxels", "--level", 0, "-o", folder / f"{size}.ply")["count"]
                  for size, tree in trees.items()}

        triangles = read_stl(command.mesh("lower"))
        panels = [("mesh, {:,} triangles".format(len(triangles)), (0.93, 0.88, 0.78), lambda c: c.add_triangles(triangles))]
        for size in (4, 1):
            vertices, faces = read_ply(folder / f"{size}.ply")
            quads = positions(vertices)[faces]
            both = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
            panels.append((f"voxels of {size} mm, {voxels[size]:,}", (0.72, 0.82, 0.93), lambda c, b=both: c.add_triangles(b)))
        for policy in ("simple", "table", "tight"):
            spheres = command.spheres(trees[1], policy, LEVEL)
            volume = 4 / 3 * np.pi * (spheres[:, 3] ** 3).sum() / 1000
            panels.append((f"{policy}: {len(spheres):,} spheres of level {LEVEL}, {volume:,.0f} cm³", (0.80, 0.90, 0.74),
                           lambda c, s=spheres: c.add_spheres(s)))

        figure, places = plt.subplots(2, 3, figsize=(13.2, 8.9))
        for place, (title, colour, draw) in zip(places.flat, panels):
            canvas = Canvas(triangles.reshape(-1, 3), margin=4)
            draw(canvas)
            place.imshow(canvas.image(colour), interpolation="antialiased")
            place.set_title(title, fontsize=12)
            place.axis("off")
        figure.tight_layout()
        save_small_png(figure, output)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
