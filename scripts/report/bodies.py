"""What many bodies cost: the pairs of a tick together against one by one, a pair that is apart, and worlds of many bodies."""

from report.losses import NOT_EXPLAINED, bold_if
from report.text import number, table

PROGRAMS = ["world_bench", "loop_bench"]
SECTIONS = {"In the loop": "loop_bench", "In a world": "world_bench"}

# The goals: how many times the same pairs one by one at most, and how many µs at most.
MOST_TIMES, MOST_APART, MOST_AT_REST = 1.15, 2, 20
GRIDS = {"a_pair_apart": ("apart", MOST_APART),
         "a_pair_near_and_not_prepared": ("whose balls overlap, without a query", None),
         "hundred_at_rest": ("none near", MOST_AT_REST),
         "hundred_moving": ("none near", None)}
# What each side does that the other does not: why a goal may be missed.
TOGETHER = "a tick also divides its time among the pairs, and joins their answers"
OF_WORLD = "a world also looks for the pairs that are near, and lists them"


def chapter(results, _pictures):
    """The markdown of the chapter."""
    splint = results.runs("loop_bench", "bodies")[0]
    four = {run.parts[2]: run for run in results.runs("world_bench", "world", "four_bodies")}
    grids = {run.parts[1]: run for run in results.runs("world_bench", "world") if run.parts[1] in GRIDS}
    some = next(iter(four.values()))
    pairs = f"{some['pairs']:.0f}"
    lines = ["## Many bodies", "",
             "### In the loop", "",
             f"In the shipped scene `splint.toml` a mandible closes on a splint among fixed bodies: {number(splint['ticks'])} "
             "ticks of its plan. All pairs are asked as a tick asks them, and the same pairs one by one, in turns.", "",
             *table(["ticks", "all pairs of a tick, p50, µs", "p99, µs", "one by one, p50, µs", "p99, µs", "together / one by one"],
                    [[splint["ticks"], splint["together_p50_us"], splint["together_p99_us"], splint["one_by_one_p50_us"],
                      splint["one_by_one_p99_us"], _judged(splint["ratio"], MOST_TIMES)]]), "",
             _verdict("Together they take", splint["ratio"], MOST_TIMES, " times the pairs one by one", TOGETHER), "",
             *table(["ticks with every pair apart", "a pair, p50, µs", "p99, µs"],
                    [[splint["ticks_apart"], _judged(splint["apart_p50_us"], MOST_APART), splint["apart_p99_us"]]]), "",
             _verdict("A pair that is apart takes", splint["apart_p50_us"], MOST_APART, " µs"), "",
             "### In a world", "",
             f"{some['bodies']:.0f} bodies in {pairs} pairs, voxels of {some['voxel_size']:g} mm: two jaws that bite, a ball on the front teeth, a "
             f"bar below the lower jaw. All but one tremble by {some['tremble_voxels']:g} voxel. `World` and {pairs} queries are asked in turns.", "",
             *table(["question", "`World`, p50, µs", "p99, µs", f"{pairs} queries, p50, µs", "p99, µs", "`World` / queries"],
                    [[name, run["p50_us"], run["p99_us"], run["one_by_one_p50_us"], run["one_by_one_p99_us"],
                      _judged(run["ratio"], MOST_TIMES)] for name, run in four.items()]), "",
             *(_verdict(f"`{name}` of the world takes", run["ratio"], MOST_TIMES, " times its queries", OF_WORLD) for name, run in four.items()), "",
             "A tick of equal balls on a grid:", "",
             *table(["bodies", "a tick, µs", "at most, µs"],
                    [[_grid(name, run), _judged(run["real_time"], GRIDS[name][1]), number(GRIDS[name][1]) if GRIDS[name][1] else "–"]
                     for name, run in grids.items()]), "",
             *(_verdict(f"{_grid(name, run)}: a tick takes", run["real_time"], GRIDS[name][1], " µs")
               for name, run in grids.items() if GRIDS[name][1] is not None)]
    return lines


def _grid(name, run):
    return f"{run['bodies']:.0f} bodies, {GRIDS[name][0]}, {run['moved']:.0f} moving"


def _judged(value, most):
    """A number; bold where it misses its goal."""
    return bold_if(number(value), most is not None and value > most)


def _verdict(what, value, most, unit, reason=NOT_EXPLAINED):
    """A sentence that says whether a goal is met, and why one that is not may be missed."""
    if value <= most:
        return f"{what} {number(value)}{unit}: the goal is at most {number(most)}."
    return f"**{what} {number(value)}{unit}; the goal is at most {number(most)}** ({reason})."
