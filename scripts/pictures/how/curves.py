"""The tests of each tick with a pair cache and without one; and the certified interval of a distance by the limit of tests."""
import numpy as np

from pictures.drawing import NAMES, plt
from pictures.how.view import INK, POLICY, save

OPEN, TICKS, REST = 3.0, 1000, 200  # mm; at 1 kHz the jaws close within a second and rest a fifth of one
ROOM = 1 << 16  # pairs
MOVE = "0,0,-3"
LIMITS = [round(100 * 10 ** (step / 4)) for step in range(17)]  # 100 to a million
SHARP = 1e-4  # mm
HIGHEST = 5  # mm, of the plots


def closing():
    """Returns how far the lower jaw is from the closed pose at each tick, mm: it starts and stops smoothly."""
    time = np.linspace(0, 1, TICKS)
    return np.concatenate([OPEN * (time * time * (3 - 2 * time) - 1), np.zeros(REST)])


def tests_of(ist, files):
    """Returns by tick the tests of a search, the tests of a query that keeps a pair cache, and the leaf pairs."""
    trees = [ist.load(file) for file in files]
    fresh, kept = ist.Query(*trees), ist.Query(*trees, front_pairs=ROOM)
    pose, rows = np.eye(4), []
    for height in closing():
        pose[2, 3] = height
        found, again = fresh.leaf_pairs(pose), kept.leaf_pairs(pose)
        if found.pairs.tobytes() != again.pairs.tobytes() or not (found.complete and again.complete):
            raise SystemExit(f"pair_cache: the cache changes the leaf pairs at {height} mm")
        rows.append((found.sphere_tests, again.sphere_tests, found.count))
    return np.array(rows)


def draw_pair_cache(command, file, ist):
    fresh, kept, pairs = tests_of(ist, [command.tree(name) for name in NAMES]).T
    figure, (tests, way) = plt.subplots(2, 1, figsize=(11, 4.6), sharex=True, height_ratios=[3, 1])
    figure.subplots_adjust(left=0.075, right=0.985, top=0.97, bottom=0.11, hspace=0.12)
    ticks = np.arange(len(fresh))
    tests.step(ticks, fresh, color=POLICY["simple"], linewidth=1.5, label="a search in each tick")
    tests.step(ticks, kept, color=POLICY["slab"], linewidth=1.2, label="a pair cache kept from tick to tick")
    tests.step(ticks, np.where(pairs > 0, pairs, np.nan), color=INK, linewidth=1, linestyle=":", label="leaf pairs, the answer of both")
    tests.set(yscale="log", ylabel="tests of a tick", ylim=(0.8, 3 * fresh.max()))
    tests.legend(loc="lower right")
    way.plot(ticks, -closing(), color=INK, linewidth=1.2)
    way.set(ylabel="mm open", xlabel="tick, ms", xlim=(0, len(ticks) - 1), ylim=(0, OPEN))
    save(figure, file)
    searched = int((kept >= fresh).sum())
    return (f"The same jaws close within a second and rest: {len(ticks):,} ticks. A search in each makes {fresh.sum():,} tests, "
            f"a pair cache {kept.sum():,}; in {searched} ticks it makes as many as a search or more. The leaf pairs are the same in every tick. "
            "The tests that make the next pair cache ahead, in slices, are not in this count.")


def distances(command, files, tolerance):
    """Returns the intervals by the limit of tests, and the last one, of a query without a limit."""

    def ask(*options):
        return command.answer("collide", *files, "--move", MOVE, "--distance", tolerance, *options)

    limited = [ask("--max-tests", limit) for limit in LIMITS]
    return [(answer["distance_lower"], answer["distance_upper"]) for answer in limited], ask()


def draw_intervals(command, file):
    exact = distances(command, [command.tree(name) for name in NAMES], SHARP)
    voxels = distances(command, [command.tree(name, "--no-triangles") for name in NAMES], SHARP)
    truth = exact[1]["distance_lower"], exact[1]["distance_upper"]
    if truth[1] - truth[0] > 2 * SHARP:
        raise SystemExit(f"intervals: the distance is known from {truth[0]} to {truth[1]} alone")
    figure, places = plt.subplots(1, 2, figsize=(11, 3.6), sharey=True)
    figure.subplots_adjust(left=0.055, right=0.985, top=0.90, bottom=0.15, wspace=0.06)
    for place, (intervals, whole), title, colour in zip(
            places, (voxels, exact), ("voxels alone, by slab", "triangles, in clusters"), (POLICY["slab"], POLICY["tight"])):
        for lower, upper in [*intervals, (whole["distance_lower"], whole["distance_upper"])]:
            if lower > truth[1] or upper < truth[0]:
                raise SystemExit(f"intervals: from {lower} to {upper} there is no distance of {truth[0]}")
        lower, upper = zip(*intervals)
        place.fill_between(LIMITS, lower, upper, step="post", color=colour, alpha=0.22, linewidth=0)
        place.step(LIMITS, upper, where="post", color=colour, linewidth=1.4)
        place.step(LIMITS, lower, where="post", color=colour, linewidth=1.4, label="the certified interval")
        place.axhline(truth[0], color=INK, linewidth=1, linestyle="--", label="the distance")
        place.set(xscale="log", xlim=(LIMITS[0], LIMITS[-1]), ylim=(-0.15, HIGHEST), xlabel="limit of tests", title=title)
    places[0].set_ylabel("mm")
    places[0].legend(loc="upper right")
    save(figure, file)
    low, high = voxels[1]["distance_lower"], voxels[1]["distance_upper"]
    return (f"The distance of the same jaws, 3 mm before they close, by the limit of tests: every interval holds it. Without a limit "
            f"voxels alone tell {low:.2f} to {high:.2f} mm, and triangles {truth[0]:.4f} to {truth[1]:.4f} mm.")
