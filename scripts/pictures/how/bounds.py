"""The lookup table's balls, each with a node that has it; the cube, ball and slab of one leaf; and a node whose table ball is not nested."""
import json

import numpy as np

from pictures.drawing import VOXEL_SIZE, plt, read_stl
from pictures.how.search import Octree
from pictures.how.view import CUBE, INK, POLICY, SKIN, View, save

ACROSS = 12
ROOT = {27: "√3/2", 54: "√6/2", 81: "3/2", 96: "√24/3", 108: "√3"}  # the radius in half edges
TWO_CHILDREN = 54  # 36 times the square of the radius, in half edges, of a table ball that leaves stick out of farthest


def draw_ball(place, square, centre, masks):
    view = View(place)
    mask = max(masks, key=lambda each: (bin(each).count("1"), -each))  # the fullest node of this ball
    view.cube((-6, -6, -6), 12, INK, width=0.5, zorder=1)
    octants = [np.array([k & 1, k >> 1 & 1, k >> 2]) for k in range(8) if mask >> k & 1]
    for octant in sorted(octants, key=lambda each: each @ view.axes[2]):
        view.cube(6 * octant - 6, 6, INK, CUBE, zorder=2, width=0.5)
    view.ball(centre, square**0.5, POLICY["table"])
    view.show(13.4)
    count = f"{len(masks)} masks" if len(masks) > 1 else "1 mask"
    place.set_title(f"{mask:08b}\n{count}", fontsize=7.5, pad=3)


def draw_table(command, file):
    balls = {}  # the masks of each ball, by the square of its radius and its centre
    for entry in json.loads("\n".join(command.lines("table", "--format", "json"))):
        balls.setdefault((entry["radius_squared"], tuple(entry["centre"])), []).append(entry["mask"])
    balls = dict(sorted(balls.items(), key=lambda item: (item[0][0], min(item[1]))))
    squares = sorted({square for square, _ in balls})
    *rows, last = ([ball for ball in balls if ball[0] == square] for square in squares)
    # The circumsphere stands in the shortest row.
    at = min(range(len(rows)), key=lambda row: len(rows[row]))
    figure, places = plt.subplots(len(rows), ACROSS, figsize=(12.4, 1.32 * len(rows) + 0.1))
    figure.subplots_adjust(left=0.085, right=0.995, top=0.925, bottom=0.01, wspace=0.02, hspace=0.34)
    for place in places.flat:
        place.axis("off")
    for row, group in enumerate(rows):
        for place, (square, centre) in zip(places[row], group):
            draw_ball(place, square, centre, balls[square, centre])
        box = places[row][0].get_position()
        figure.text(0.004, (box.y0 + box.y1) / 2, f"{len(group)} balls,\nradius {ROOT[group[0][0]]}\nhalf edges", fontsize=8.5, va="center")
    for place, (square, centre) in zip(places[at][ACROSS - len(last):], last):
        draw_ball(place, square, centre, balls[square, centre])
        box = place.get_position()
        figure.text(box.x0 - 0.01, (box.y0 + box.y1) / 2, f"{len(last)} ball,\nradius {ROOT[square]} half edges,\nthe circumsphere", fontsize=8.5,
                    va="center", ha="right")
    save(figure, file)
    smaller = sum(len(masks) for (square, _), masks in balls.items() if square < max(squares))
    return (f"The {len(balls)} balls of the table, by their {len(squares)} radii. Under each mask, octant 7 first, stands how many masks have "
            f"the ball; drawn is the fullest of these nodes. {smaller} of {sum(map(len, balls.values()))} "
            "masks have a ball smaller than the circumsphere.")


def clipped(polygon, low, high):
    """Returns the part of a polygon in a box (Sutherland and Hodgman)."""
    for axis in range(3):
        for sign, border in ((1, high[axis]), (-1, -low[axis])):
            kept = []
            for here, there in zip(polygon, [*polygon[1:], *polygon[:1]]):
                a, b = border - sign * here[axis], border - sign * there[axis]
                if a >= 0:
                    kept.append(here)
                if a * b < 0:
                    kept.append(here + (there - here) * a / (a - b))
            polygon = kept
    return polygon


class Leaf:
    """A leaf with a visible slab, thicker than the slabs of nine in ten leaves, and the pieces of triangles in its cube."""

    def __init__(self, command, tree):
        cubes, tight = tree.cubes[0], tree.bounds("slab", 0)
        self.index = np.argsort(tight.half, kind="stable")[9 * len(cubes) // 10]
        self.centre, self.circumradius = cubes[self.index, :3], cubes[self.index, 3]
        self.low, high = (self.centre + side * VOXEL_SIZE / 2 for side in (-1, 1))
        triangles = read_stl(command.mesh("lower"))
        near = ((triangles.max(1) >= self.low) & (triangles.min(1) <= high)).all(1)
        pieces = (clipped(list(triangle), self.low, high) for triangle in triangles[near])
        self.pieces = [np.array(piece) for piece in pieces if len(piece) > 2]
        self.ball = tight.centre[self.index], tight.radius[self.index]
        normal, self.half = tight.normal[self.index], tight.half[self.index]
        self.length = np.linalg.norm(normal)
        self.normal = normal / self.length
        self.middle = self.ball[0] + self.normal * tight.offset[self.index] / self.length

    def check(self):
        """Fails if a bound does not hold the pieces. That would be a flaw of this picture, or worse."""
        points = np.concatenate(self.pieces)
        rounding = 1e-5 * np.abs(points).max()
        if (np.linalg.norm(points - self.ball[0], axis=1) > self.ball[1] + rounding).any():
            raise SystemExit("leaf_bounds: the tight ball does not hold its triangles")
        if (np.abs((points - self.middle) @ self.normal) > self.half / self.length + rounding).any():
            raise SystemExit("leaf_bounds: the slab does not hold its triangles")


def draw_slab(view, leaf):
    centre, radius = leaf.ball
    for side in (-1, 1):
        at = leaf.middle + side * leaf.normal * leaf.half / leaf.length
        height = (at - centre) @ leaf.normal
        if abs(height) < radius:
            view.disc(centre + height * leaf.normal, leaf.normal, np.sqrt(radius**2 - height**2), POLICY["slab"])


def draw_node(place, tree):
    """Draws a node of level 1 of two leaves; returns by how much their balls stick out of its own, in voxels."""
    published = tree.command.spheres(tree.file, "table", 1)
    squares = np.rint(36 * (published[:, 3] / VOXEL_SIZE) ** 2)
    first, count = tree.children[1]
    pairs = np.flatnonzero((squares == TWO_CHILDREN) & (count == 2))
    apart = tree.cubes[0][first[pairs] + 1, 2] - tree.cubes[0][first[pairs], 2]
    node = pairs[apart.argmax()]  # one above the other, so that this view shows what sticks out
    cube = tree.cubes[1][node, :3]
    view = View(place, (cube + published[node, :3]) / 2)
    view.cube(cube - VOXEL_SIZE, 2 * VOXEL_SIZE, INK, width=0.5)
    out = 0
    for leaf in tree.cubes[0][first[node]:first[node] + 2]:
        view.cube(leaf[:3] - VOXEL_SIZE / 2, VOXEL_SIZE, INK, CUBE, zorder=2)
        view.ball(leaf[:3], leaf[3], POLICY["simple"], alpha=0.10)
        out = max(out, np.linalg.norm(leaf[:3] - published[node, :3]) + leaf[3] - published[node, 3])
    view.ball(published[node, :3], published[node, 3], POLICY["table"], alpha=0)
    tested = tree.bounds("table", 1).radius[node]
    view.ball(published[node, :3], tested, "black", alpha=0, width=1.1)
    view.show(1.75 * VOXEL_SIZE)
    return out / VOXEL_SIZE, (tested - published[node, 3]) / VOXEL_SIZE


def draw_bounds(command, file):
    tree = Octree(command, command.tree("lower"))
    leaf = Leaf(command, tree)
    leaf.check()
    figure, places = plt.subplots(1, 4, figsize=(12.4, 3.5))
    figure.subplots_adjust(left=0.005, right=0.995, top=0.86, bottom=0.01, wspace=0.03)
    for place, (title, centre, radius, colour) in zip(places, (
            ("simple, table: the circumsphere,", leaf.centre, leaf.circumradius, POLICY["table"]),
            ("tight: the ball round the pieces,", *leaf.ball, POLICY["tight"]),
            ("slab: that ball, cut by a slab of", *leaf.ball, POLICY["tight"]))):
        view = View(place, leaf.centre)
        view.cube(leaf.low, VOXEL_SIZE, INK)
        view.faces(leaf.pieces, SKIN, INK)
        view.ball(centre, radius, colour, alpha=0.10)
        place.set_title(f"{title}\nradius {radius:.3f} mm")
        view.show(0.92 * VOXEL_SIZE)
    draw_slab(view, leaf)
    thick = 2 * leaf.half / leaf.length
    places[2].set_title(f"slab: that ball, cut by a slab\n{thick:.3f} mm thick")
    out, more = draw_node(places[3], tree)
    places[3].set_title(f"above the leaves: the table's ball lacks\n{out:.4f} voxels of its leaves' balls")
    save(figure, file)
    return (f"A voxel of {VOXEL_SIZE} mm of the lower jaw, less flat than nine in ten, with the pieces of {len(leaf.pieces)} triangles in it: its "
            f"circumsphere has a radius of {leaf.circumradius:.3f} mm, its tight ball of {leaf.ball[1]:.3f} mm, and its slab is {thick:.3f} mm "
            f"thick. On the right a node of two voxels: their balls (grey) stick out of the published ball (orange) by {out:.4f} voxels, and the "
            f"search tests one that is {more:.4f} voxels larger (black).")
