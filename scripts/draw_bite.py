#!/usr/bin/env python3
"""Draws the picture of docs/occlusion.md: how far two jaws are from each other, opened like a book, and where they touch.

    scripts/draw_bite.py PATH/TO/ist OUTPUT.png

All that is drawn comes from the command: the built-in jaws, and the files that `ist occlusion` writes of them. Needs
Debian's python3-matplotlib, so run it with the system's python3.
"""
import json
import pathlib
import sys
import tempfile

import numpy as np

from pictures.drawing import NAMES, Command, DepthBuffer, plt, positions, read_ply, save_small_png

BITE = ["--move", "0,0,-0.6", "--preset", "stl"]
WIDTH, HEIGHT = 900, 760  # pixels of one jaw's half
FINE = 3  # samples along the edge of a pixel
PIXELS_PER_MM = 11.6
HIGHEST = 0.965  # where the foremost point of a jaw is, of the height
FADE = 0.16  # of the height, in which jaws that go on below end
SIDE_FADE = 0.05  # of the width, in which jaws that go on at the sides end
LIGHT = np.array([-0.40, 0.50, 1.0])  # right, up, towards the eye
BARE = np.array([226, 221, 211])
HATCH = 10  # pixels from line to line
GREY = "#333333"


def unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-30)


class Bands:
    """The bands of a distance map, mm, and their colours, which the command gave the vertices that lie in them."""

    def __init__(self, report, vertices):
        self.error = report["scanner_band_micrometres"] / 1000
        limits = [limit / 1000 for limit in report["preset"]["micrometres"] if limit > 0]
        self.ends = np.array([-self.error, 0, *limits, report["reach"]])
        self.hatched = np.array([False, True, *(limit < self.error for limit in limits), False])
        colours = np.stack([vertices[name] for name in ("red", "green", "blue")], axis=1)
        known = ~np.isnan(vertices["signed"])
        band = np.where(known, self.of(vertices["signed"]), -1)
        self.colours = []
        for i in range(len(self.ends)):
            found, count = np.unique(colours[band == i], axis=0, return_counts=True)
            if len(found) == 0:
                sys.exit(f"no vertex is in band {i} of the map: move the jaws so that the legend is complete")
            self.colours.append(found[count.argmax()])
        self.colours = np.array(self.colours, float)

    def of(self, distances):
        return np.searchsorted(self.ends, distances, side="left")


class Jaw:
    """One body of the opened bite, as its reader sees it: points in mm to the right, up, and towards the eye."""

    def __init__(self, vertices, faces, role, axes):
        mine = vertices["body"] == role
        first = np.flatnonzero(mine)[0]
        self.points = positions(vertices[mine]) @ axes.T
        self.signed = vertices["signed"][mine].astype(float)
        self.faces = faces[mine[faces[:, 0]]] - first
        corners = self.points[self.faces]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        self.normals = np.zeros_like(self.points)
        for i in range(3):
            np.add.at(self.normals, self.faces[:, i], across)
        edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
        ends = self.signed[self.faces]
        # As in the report of `ist occlusion`: known at all corners, and nowhere steeper than a distance can be.
        self.is_mapped = (np.abs(ends - np.roll(ends, 1, axis=1)) <= 1.001 * edges).all(1)

    def place(self, points):
        """Returns where points are in the picture, in pixels from its lower left corner."""
        low, high = self.points.min(0), self.points.max(0)
        middle = np.array([(low[0] + high[0]) / 2, high[1], 0])
        return (points - middle) * PIXELS_PER_MM + (WIDTH / 2, HIGHEST * HEIGHT, 0)

    def draw(self, bands):
        buffer = DepthBuffer(FINE * WIDTH, FINE * HEIGHT)
        buffer.draw(FINE * self.place(self.points), self.faces)
        seen = np.flatnonzero(buffer.triangle >= 0)
        triangle = buffer.triangle[seen]
        corners, weights = self.faces[triangle], buffer.weights[seen]
        distance = (self.signed[corners] * weights).sum(1)
        colour = np.tile(BARE.astype(float), (len(seen), 1))
        mapped = self.is_mapped[triangle] & (distance <= bands.ends[-1])
        band = bands.of(distance[mapped])
        y, x = np.divmod(seen[mapped], buffer.width)
        lines = bands.hatched[band] & ((x + y) % (FINE * HATCH) < FINE * HATCH // 3)
        colour[mapped] = np.where(lines[:, None], 255, bands.colours[band])
        normals = unit((self.normals[corners] * weights[..., None]).sum(1))
        samples = np.full((FINE * HEIGHT * FINE * WIDTH, 3), 255.0)
        samples[seen] = shaded(colour, normals)
        image = samples.reshape(HEIGHT, FINE, WIDTH, FINE, 3).mean((1, 3))
        return 255 + faded()[..., None] * (image - 255)


def faded():
    """Returns how much of a half's pixels is left: none at the lower edge and at the sides, where jaws go on."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    from_side = np.minimum(x, WIDTH - 1 - x)
    return smooth(y / (FADE * HEIGHT)) * smooth(from_side / (SIDE_FADE * WIDTH))


def smooth(part):
    part = np.clip(part, 0, 1)
    return part * part * (3 - 2 * part)


def shaded(colour, normals):
    """Returns colours as light falls on them; a surface that faces the eye keeps its own."""
    lit = np.clip(normals @ LIGHT, 0, None)[:, None]
    darker = colour * (0.62 + 0.38 * np.minimum(lit, 1))
    return darker + np.minimum(2.2 * np.maximum(lit - 1, 0), 0.25) * (255 - darker)


def measured(ist, folder):
    """Returns the vertices as bitten and as opened, the faces, and the report."""
    command = Command(ist, folder)
    jaws = [command.mesh(name) for name in NAMES]
    command.lines("occlusion", *jaws, *BITE, "-o", folder / "bite.ply", "-o", folder / "bite.json")
    command.lines("occlusion", *jaws, *BITE, "-o", folder / "book.ply", "--open", 8)
    bitten, _ = read_ply(folder / "bite.ply")
    book, faces = read_ply(folder / "book.ply")
    return bitten, book, faces, json.loads((folder / "bite.json").read_text())


def axes_of(book):
    """Returns the directions to the right, up and towards the eye, so that the opened jaws lie side by side."""
    upper, lower = (positions(book[book["body"] == role]).mean(0) for role in (0, 1))
    axis = np.abs(lower - upper).argmax()
    right = np.sign(lower - upper)[axis] * np.eye(3)[axis]
    up = np.array([0.0, -1.0, 0.0])  # where the built-in jaws have their front teeth
    return np.array([right, up, np.cross(right, up)])


def closest_points(jaw, bitten, regions):
    """Returns where the closest points of contact regions are on the opened jaw, which is moved as a whole."""
    points = np.array([region["closest"] for region in regions]).reshape(-1, 3)
    closed = positions(bitten)
    opening = np.linalg.lstsq(np.column_stack([closed, np.ones(len(closed))]), jaw.points, rcond=None)[0]
    return np.column_stack([points, np.ones(len(points))]) @ opening


def draw_half(place, jaw, bands, bitten, regions, title, facts):
    place.imshow(np.clip(jaw.draw(bands), 0, 255).astype(np.uint8), origin="lower", extent=(0, WIDTH, 0, HEIGHT))
    paired = np.array([region["partner"] is not None for region in regions], bool)
    points = jaw.place(closest_points(jaw, bitten, regions))
    for chosen, core, ring in ((paired, "black", "white"), (~paired, "white", "black")):
        place.scatter(*points[chosen, :2].T, s=30, c=core, edgecolors=ring, linewidths=1.3)
    words = {"ha": "center", "va": "top", "color": GREY}
    place.text(WIDTH / 2, HEIGHT * 0.44, title, fontsize=22, fontweight="bold", **words)
    place.text(WIDTH / 2, HEIGHT * 0.375, facts, fontsize=18, linespacing=1.5, **words)
    place.set(xlim=(0, WIDTH), ylim=(0, HEIGHT))
    place.axis("off")


def draw_legend(place, bands):
    for i, colour in enumerate(bands.colours):
        place.add_patch(plt.Rectangle((i, 0), 1, 1, facecolor=colour / 255, edgecolor="white", linewidth=0,
                                      hatch="//" if bands.hatched[i] else None))
    for i, end in enumerate(bands.ends):
        place.text(i + 1, -0.18, f"{end:g}".replace("-", "−"), fontsize=18, ha="center", va="top")
    zero = list(bands.ends).index(0) + 1
    reach = zero + bands.error / bands.ends[zero]
    place.plot([zero - 1, zero - 1, reach, reach], [1.15, 1.4, 1.4, 1.15], color=GREY, linewidth=1.2)
    place.text((zero - 1 + reach) / 2, 1.55, f"± {bands.error:g} mm assumed\nfor scanning", fontsize=16,
               ha="center", va="bottom")
    last = len(bands.ends)
    place.text(-0.12, 0.5, "overlap", fontsize=18, ha="right", va="center")
    place.text(last + 0.12, 0.5, "mm apart", fontsize=18, ha="left", va="center")
    place.scatter([last + 1.3], [0.5], s=60, c="black", edgecolors="white", linewidths=1.3)
    place.text(last + 1.42, 0.5, "closest point of\na contact region", fontsize=18, ha="left", va="center")
    place.set(xlim=(-0.9, last + 3.1), ylim=(-1.1, 3.3))
    place.axis("off")


def facts_of(body):
    regions = body["regions"]
    within = body["areas"][0]
    return (f"{within['area']:.1f} mm² within {within['micrometres'] / 1000:g} mm\n"
            f"or overlapping; {len(regions)} contacts")


def main(ist, output):
    with tempfile.TemporaryDirectory() as name:
        bitten, book, faces, report = measured(pathlib.Path(ist).resolve(), pathlib.Path(name))
    axes, bands = axes_of(book), Bands(report, book)
    figure = plt.figure(figsize=(18, 9.2), dpi=100)
    for role, (key, title) in enumerate((("fixed", "upper jaw"), ("moving", "lower jaw"))):
        place = figure.add_axes((role / 2, 1.6 / 9.2, 0.5, 7.6 / 9.2))
        draw_half(place, Jaw(book, faces, role, axes), bands, bitten[bitten["body"] == role],
                  report[key]["regions"], title, facts_of(report[key]))
    draw_legend(figure.add_axes((0.02, 0.01, 0.96, 1.6 / 9.2)), bands)
    save_small_png(figure, output)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
