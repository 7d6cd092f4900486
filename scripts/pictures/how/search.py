"""The octree, level by level; and one query, frontier by frontier: the pairs of nodes that are alive after each step."""
import functools
import struct

import numpy as np
from matplotlib.collections import EllipseCollection, PolyCollection

from pictures.drawing import NAMES, POLICIES, VOXEL_SIZE, plt, save_small_png
from pictures.how.view import CUBE, FIXED, INK, MOVING, PALE, POLICY, SHADES, View, face_of_cube

VERSION = 5  # of tree files, whose layout src/ist/tree/tree_file.cpp describes
SECTIONS = 1 | 2 | 8  # balls, triangles, slabs
# The excess of the table's balls in a query, in voxels, at level 1 and above it, by 36 times the square of the radius in half edges.
# docs/guarantees.md, Nested bounds, derives it.
EXCESS = {27: (0, 0), 54: (0.1413, 0.0749), 81: (0.0732, 0.0455), 96: (0.0991, 0.0665), 108: (0, 0)}
VOXEL = 4  # mm: the whole octree is seen
MOVE = np.array([0, 0, -1.5])  # just before the jaws touch
ROUNDING = 2.0**-24
INNER, LEAF = (37.5, 53), (12.5, 17)  # pads of balls and of slabs: docs/guarantees.md, Search pose in float


class Bounds:
    """The bounds of one level: balls, and slabs if the policy has them."""

    def __init__(self, spheres, slabs=None):
        self.centre, self.radius = spheres[:, :3], spheres[:, 3]
        self.normal, self.offset, self.half = slabs if slabs is not None else (None, None, None)


class Octree:
    """The levels of a tree file, the leaves first."""

    def __init__(self, command, file):
        self.command, self.file = command, file
        self.depth, self.counts, self.slabs = read_tree(file)
        self.cubes = [command.spheres(file, "simple", level) for level in range(self.depth + 1)]
        corner = self.cubes[-1][0, :3] - VOXEL_SIZE * 2 ** (self.depth - 1)
        self.children = [None]  # of each node at a level: the first child's index, and how many there are
        for level in range(1, self.depth + 1):
            cells = [np.floor((self.cubes[at][:, :3] - corner) / (VOXEL_SIZE * 2**at)).astype(int) for at in (level - 1, level)]
            new = np.any(np.diff(cells[0] // 2, axis=0) != 0, axis=1)  # siblings follow each other
            first = np.concatenate([[0], 1 + np.flatnonzero(new)])
            if len(first) != len(cells[1]) or (cells[0][first] // 2 != cells[1]).any():
                raise SystemExit(f"{file}: the children of level {level} are not in the order of their parents")
            self.children.append((first, np.diff(np.append(first, len(cells[0])))))

        half = VOXEL_SIZE * 2 ** (self.depth - 1)
        self.bounding_radius = (12**0.5 + 96**0.5) / 6 * half + EXCESS[96][1] * VOXEL_SIZE  # of any policy's: guarantees.md

    @functools.cache
    def bounds(self, policy, level):
        """Returns the bounds of a level."""
        if policy == "simple":
            return Bounds(self.cubes[level])
        spheres = self.command.spheres(self.file, policy, level)
        if policy == "table" and level > 0:
            half = VOXEL_SIZE * 2 ** (level - 1)
            squares = np.rint(36 * (spheres[:, 3] / half) ** 2).astype(int)
            spheres[:, 3] += VOXEL_SIZE * np.array([EXCESS[square][min(level, 2) - 1] for square in squares])
        return Bounds(spheres, self.slabs[level] if policy == "slab" else None)


def read_tree(file):
    """Returns a tree file's depth, its nodes a level, and its slabs a level: normals, offsets, half widths, mesh units."""
    data = file.read_bytes()
    version, = struct.unpack_from("<I", data, 8)
    size, _, depth, _, sections, _, _, name = struct.unpack_from("<dIIIIQII", data, 32 + 24)
    if version != VERSION or sections & SECTIONS != SECTIONS:
        raise SystemExit(f"{file}: no tree file of version {VERSION} with balls, slabs and triangles")
    at = 32 + 64 + name
    *above, leaves = struct.unpack_from(f"<{depth + 1}I", data, at)
    counts = [leaves, *above]
    at += 4 * len(counts) + sum(above) + 4 * leaves + 8 * sum(counts)
    rows = np.frombuffer(data, np.dtype([("normal", "i1", 3), ("offset", "i1"), ("half", "u1")]), sum(counts), at)
    slabs = []
    for level, part in enumerate(np.split(rows, np.cumsum(counts)[:-1])):
        unit = size * 2**level / 256
        slabs.append((part["normal"] / 128, part["offset"] * unit, part["half"] * unit))
    return depth, counts, slabs


def draw_cubes(place, view, centres, edge):
    """Draws cubes of one grid, those that are far first, by the faces that look at the eye."""
    faces = [view.seen(view.centre + edge * (face_of_cube(axis, view.near_side(axis)) - 0.5))[:, :2] for axis in range(3)]
    at = view.seen(centres)
    at = at[np.argsort(at[:, 2], kind="stable")]
    polygons = (at[:, None, None, :2] + np.array(faces)).reshape(-1, 4, 2)
    colours = np.tile([np.array(CUBE) * shade for shade in SHADES], (len(at), 1))
    place.add_collection(PolyCollection(polygons, facecolors=colours, edgecolors=INK, linewidths=0.4))


def mask_of(parent, centres, edge):
    """Returns the bits of a node's children, octant 7 first; `edge` is a child's."""
    below = centres[(np.abs(centres - parent) < edge).all(1)]
    octants = {int(k) for k in ((below > parent) @ [1, 2, 4])}
    return "".join("1" if k in octants else "0" for k in range(7, -1, -1))


def draw_octree(command, file):
    tree = command.tree("lower", voxel_size=VOXEL)
    depth = command.answer("info", tree)["depth"]
    # The centres of the nodes of each level, and the edge of their cubes.
    levels = [(spheres[:, :3], 2 * spheres[0, 3] / 3**0.5) for level in range(depth + 1) for spheres in [command.spheres(tree, "simple", level)]]
    figure = plt.figure(figsize=(11, 7.4))
    places = figure.subplots(2, (depth + 2) // 2).flat
    figure.subplots_adjust(left=0.005, right=0.995, top=0.94, bottom=0.005, wspace=0.02, hspace=0.12)
    for place in places:
        place.axis("off")
    places = figure.axes
    (root,), edge = levels[depth]
    body = (levels[0][0].min(0) + levels[0][0].max(0)) / 2
    leaf = levels[0][0][View(places[0], root).seen(levels[0][0])[:, 2].argmax()]  # the nearest one to the eye
    for place, level in zip(places, range(depth, -1, -1)):
        centres, size = levels[level]
        node = np.abs(centres - leaf).max(1).argmin()
        whole = size > edge / 8  # below, only the body is left
        view = View(place, root if whole else body)
        draw_cubes(place, view, centres, size)
        view.cube(centres[node] - size / 2, size, MOVING, zorder=3, width=1.8)
        view.show((0.83 if whole else 0.60) * edge)
        bits = f", {mask_of(centres[node], *levels[level - 1])}" if level else ""
        place.set_title(f"level {level}: {len(centres):,} node{'s' * (len(centres) > 1)}{bits}")
    save_small_png(figure, file)
    count = sum(len(centres) for centres, _ in levels)
    return (f"The octree of the lower jaw in voxels of {VOXEL} mm: {count:,} nodes, of {(8 ** (depth + 1) - 1) // 7:,} that fill space at this "
            "depth. Red is the way down to one voxel, with the eight bits of each node on it, octant 7 first.")


def overlapping(fixed, moving, pairs, pads):
    """Returns the pairs of nodes whose bounds overlap."""
    a, b = pairs
    way = moving.centre[b] + MOVE - fixed.centre[a]
    kept = (way**2).sum(1) <= (fixed.radius[a] + moving.radius[b] + pads[0]) ** 2
    if fixed.normal is not None:
        kept &= np.abs((fixed.normal[a] * way).sum(1) - fixed.offset[a]) <= fixed.half[a] + moving.radius[b] + pads[1]
        kept &= np.abs((moving.normal[b] * way).sum(1) + moving.offset[b]) <= moving.half[b] + fixed.radius[a] + pads[1]
    return a[kept], b[kept]


def children_of(tree, level, nodes):
    """Returns the children of each node of a list, and which of them each belongs to."""
    first, count = (array[nodes] for array in tree.children[level])
    owner = np.repeat(np.arange(len(nodes)), count)
    return first[owner] + np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count), owner


def search(trees, policy):
    """Goes down both trees as a query does. Returns for each step the levels, the tests, and the pairs that are alive."""
    levels = [tree.depth for tree in trees]
    origins = [tree.cubes[-1][0, :3] for tree in trees]
    lengths = ROUNDING * (sum(tree.bounding_radius for tree in trees) + np.linalg.norm(origins[1] + MOVE - origins[0]))
    pairs, steps = (np.zeros(1, int), np.zeros(1, int)), []
    tests = 1
    while True:
        bounds = [tree.bounds(policy, level) for tree, level in zip(trees, levels)]
        pads = [pad * lengths for pad in (INNER if max(levels) > 0 else LEAF)]
        pairs = overlapping(*bounds, pairs, pads)
        steps.append((tuple(levels), tests, pairs))
        if max(levels) == 0:
            return steps
        before = list(levels)
        for side in (0, 1):  # voxels of one size: the deeper tree goes first, and then both
            if before[side] >= before[1 - side]:
                below, owner = children_of(trees[side], levels[side], pairs[side])
                other = pairs[1 - side][owner]
                pairs = (below, other) if side == 0 else (other, below)
                levels[side] -= 1
        tests = len(pairs[0])


def asked_of(command, files, policy, *options):
    return command.answer("collide", *files, "--move", ",".join(map(str, MOVE)), "--spheres", policy, *options)


def held_against_command(command, files, policy, steps):
    """Fails if the command counts other numbers in all. Returns its answer."""
    answer = asked_of(command, files, policy)
    found = sum(tests for _, tests, _ in steps), len(steps[-1][2][0])
    if found != (answer["sphere_tests"], answer["leaf_pairs"]):
        raise SystemExit(f"{policy}: {found} tests and leaf pairs are drawn, and the command counts "
                         f"{answer['sphere_tests']} and {answer['leaf_pairs']}")
    return answer


def hold_steps_against_command(command, files, policy, steps):
    """Fails if a limit of tests ends the command's query at another step than these counts tell."""
    spent = 0
    for at, (_, tests, _) in enumerate(steps[:-1]):
        spent += tests
        left = len(steps) - 1 - at
        for limit, expected in ((spent, left), (spent - 1, left + 1)):
            if limit < 1:  # no limit
                continue
            level = asked_of(command, files, policy, "--max-tests", limit)["level"]
            if level != expected:
                raise SystemExit(f"{policy}: {limit} tests end {level} steps above the leaves, and {expected} are drawn")


def draw_nodes(place, tree, level, nodes, move, colour):
    cubes = tree.bounds("slab", level)
    nodes = np.unique(nodes)
    centre, size = cubes.centre[nodes] + move, 2 * cubes.radius[nodes]
    size = np.maximum(size, 1.2)
    place.add_collection(EllipseCollection(size, size, np.zeros(len(nodes)), units="xy", offsets=centre[:, :2], facecolors=colour,
                                           edgecolors=colour, alpha=0.35, linewidths=0.6, offset_transform=place.transData))


def draw_frontiers(command, file):
    files = [command.tree(name) for name in NAMES]
    trees = [Octree(command, tree) for tree in files]
    found = {policy: search(trees, policy) for policy in POLICIES}
    answers = {policy: held_against_command(command, files, policy, steps) for policy, steps in found.items()}
    hold_steps_against_command(command, files, "slab", found["slab"])

    figure = plt.figure(figsize=(11, 8.6))
    grid = figure.add_gridspec(3, 4, height_ratios=[1, 1, 0.95], hspace=0.28, wspace=0.05, left=0.06, right=0.99, top=0.96, bottom=0.07)
    shown = found["slab"][1:]
    for at, (levels, tests, pairs) in enumerate(shown[:8]):
        place = figure.add_subplot(grid[at // 4, at % 4])
        leaves = trees[1].cubes[0][::7, :2]
        place.scatter(*leaves.T, s=0.4, c=PALE, linewidths=0)
        draw_nodes(place, trees[0], levels[0], pairs[0], np.zeros(3), FIXED)
        draw_nodes(place, trees[1], levels[1], pairs[1], MOVE, MOVING)
        place.set(xlim=(-62, 62), ylim=(-60, 44), aspect="equal")
        place.axis("off")
        place.set_title(f"level {max(levels)}: {tests:,} tests, {len(pairs[0]):,} " + ("pairs" if max(levels) else "leaf pairs"))
    bars = figure.add_subplot(grid[2, :])
    for at, policy in enumerate(POLICIES):
        steps = found[policy][1:]
        where = np.arange(len(steps)) + 0.2 * (at - 1.5)
        bars.bar(where, [tests for _, tests, _ in steps], 0.19, color=POLICY[policy],
                 label=f"{policy}: {answers[policy]['sphere_tests']:,} tests, {answers[policy]['leaf_pairs']:,} leaf pairs")
        bars.scatter(where, [max(1, len(pairs[0])) for _, _, pairs in steps], s=22, c="white", edgecolors="black", linewidths=0.9, zorder=3,
                     label="pairs alive after the step" if at == 3 else None)
    bars.set(yscale="log", ylabel="tests of a step", xticks=range(len(shown)), xticklabels=[f"level {max(levels)}" for levels, _, _ in shown])
    bars.legend(loc="upper left", fontsize=9)
    save_small_png(figure, file)
    return ("The built-in jaws, voxels of 0.8 mm, 1.5 mm before they close: a query by `slab`, seen from above. "
            "Blue are the upper jaw's nodes that are alive, red the lower jaw's. " +
            "; ".join(f"`{policy}` makes {answer['sphere_tests']:,} sphere tests and finds {answer['leaf_pairs']:,} leaf pairs"
                      for policy, answer in answers.items()) + ".")
