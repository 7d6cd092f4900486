"""One query, frontier by frontier: the pairs of nodes that are alive after each step."""
import numpy as np
from matplotlib.collections import EllipseCollection

from pictures.how.command import NAMES, POLICIES
from pictures.how.octree import Octree
from pictures.how.style import FIXED, MOVING, PALE, POLICY, plt
from pictures.small_png import save_small_png

MOVE = np.array([0, 0, -1.5])  # just before the jaws touch
ROUNDING = 2.0**-24
INNER, LEAF = (37.5, 53), (12.5, 17)  # pads of balls and of slabs: docs/guarantees.md, Search pose in float


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
    """Fails where the command counts otherwise in all, and returns its answer."""
    answer = asked_of(command, files, policy)
    found = sum(tests for _, tests, _ in steps), len(steps[-1][2][0])
    if found != (answer["sphere_tests"], answer["leaf_pairs"]):
        raise SystemExit(f"{policy}: {found} tests and leaf pairs are drawn, and the command counts "
                         f"{answer['sphere_tests']} and {answer['leaf_pairs']}")
    return answer


def hold_steps_against_command(command, files, policy, steps):
    """Fails where a limit of tests ends the command's query at another step than it would by these counts."""
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


def draw(command, file):
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
