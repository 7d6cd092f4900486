"""The bounds of one leaf: its cube and circumsphere, its tight ball and its slab; and a node whose table ball is not nested."""
import numpy as np

from pictures.how.command import VOXEL_SIZE
from pictures.how.octree import Octree
from pictures.how.style import INK, POLICY, plt, save
from pictures.how.view import View

SKIN = (0.93, 0.86, 0.70)
TWO_CHILDREN = 54  # 36 times the square of the radius, in half edges, of a table ball that leaves stick out of farthest


def read_stl(file):
    rows = np.frombuffer(file.read_bytes(), np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]), offset=84)
    return rows["v"].astype(float)


def clipped(polygon, low, high):
    """Returns what a box leaves of a polygon (Sutherland and Hodgman)."""
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
    """A leaf with a slab thick enough to be seen, thicker than those of nine in ten, and the pieces of triangles in its cube."""

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
        """Fails where a bound does not hold the pieces, which would be a flaw of this picture, or worse."""
        points = np.concatenate(self.pieces)
        rounding = 1e-5 * np.abs(points).max()
        if (np.linalg.norm(points - self.ball[0], axis=1) > self.ball[1] + rounding).any():
            raise SystemExit("leaf_bounds: the tight ball does not hold its triangles")
        if (np.abs((points - self.middle) @ self.normal) > self.half / self.length + rounding).any():
            raise SystemExit("leaf_bounds: the slab does not hold its triangles")

    def draw_content(self, view):
        view.cube(self.low, VOXEL_SIZE, INK)
        view.faces(self.pieces, SKIN, INK)


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
        view.cube(leaf[:3] - VOXEL_SIZE / 2, VOXEL_SIZE, INK, (0.80, 0.87, 0.94), zorder=2)
        view.ball(leaf[:3], leaf[3], POLICY["simple"], alpha=0.10)
        out = max(out, np.linalg.norm(leaf[:3] - published[node, :3]) + leaf[3] - published[node, 3])
    view.ball(published[node, :3], published[node, 3], POLICY["table"], alpha=0)
    tested = tree.bounds("table", 1).radius[node]
    view.ball(published[node, :3], tested, "black", alpha=0, width=1.1)
    view.show(1.75 * VOXEL_SIZE)
    return out / VOXEL_SIZE, (tested - published[node, 3]) / VOXEL_SIZE


def draw(command, file):
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
        leaf.draw_content(view)
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
