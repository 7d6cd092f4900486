"""A pair cache: the tests of each tick along a closing motion, by a query that keeps leaf pairs and by one that does not."""
import numpy as np

from pictures.how.command import NAMES
from pictures.how.style import INK, POLICY, plt, save

OPEN, TICKS, REST = 3.0, 1000, 200  # mm; at 1 kHz the jaws close within a second and rest a fifth of one
ROOM = 1 << 16  # pairs


def closing():
    """Returns how far the lower jaw is from the closed pose at each tick, mm: it starts and stops smoothly."""
    time = np.linspace(0, 1, TICKS)
    return np.concatenate([OPEN * (time * time * (3 - 2 * time) - 1), np.zeros(REST)])


def tests_of(ist, files):
    """Returns the tests of each tick by a search, those of a query that keeps a pair cache, and the leaf pairs."""
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


def draw(command, file, ist):
    fresh, kept, pairs = tests_of(ist, [command.tree(name) for name in NAMES]).T
    figure, (tests, way) = plt.subplots(2, 1, figsize=(11, 4.6), sharex=True, height_ratios=[3, 1])
    figure.subplots_adjust(left=0.075, right=0.985, top=0.97, bottom=0.11, hspace=0.12)
    ticks = np.arange(len(fresh))
    tests.step(ticks, fresh, color=POLICY["simple"], linewidth=1.5, label="a search in each tick")
    tests.step(ticks, kept, color=POLICY["slab"], linewidth=1.2, label="a front carried from tick to tick")
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
