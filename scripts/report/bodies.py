"""What many bodies cost: the pairs of a tick together against one by one, a pair that is apart, and a world of a hundred bodies."""

from report.text import number, table

PROGRAMS = ["world_bench", "loop_bench"]
SECTIONS = {"In the loop": "loop_bench", "In a world": "world_bench"}

# The most that is promised: times the same pairs one by one, and µs.
MOST_TIMES, MOST_APART, MOST_AT_REST = 1.15, 2, 20
GRIDS = {"a_pair_apart": ("two bodies, apart; one moves", MOST_APART),
         "a_pair_near_and_not_prepared": ("two bodies whose balls overlap, without a query; one moves", None),
         "hundred_at_rest": ("100 bodies, none near, at rest", MOST_AT_REST),
         "hundred_moving": ("100 bodies, none near, all moving", None)}


def chapter(results, _pictures):
    """The markdown of the chapter."""
    splint = results.runs("loop_bench", "bodies")[0]
    four = {run.parts[2]: run for run in results.runs("world_bench", "world", "four_bodies")}
    grids = {run.parts[1]: run for run in results.runs("world_bench", "world") if run.parts[1] in GRIDS}
    lines = ["## Many bodies", "",
             "### In the loop", "",
             f"The shipped scene `splint.toml` has four fixed bodies and a mandible that closes on the splint: {number(splint['ticks'])} "
             "ticks of its plan. All pairs are asked as a tick asks them, and the same pairs one by one, in turns.", "",
             *table(["ticks", "all pairs of a tick, p50, µs", "p99, µs", "one by one, p50, µs", "p99, µs", "together / one by one"],
                    [[splint["ticks"], splint["together_p50_us"], splint["together_p99_us"], splint["one_by_one_p50_us"],
                      splint["one_by_one_p99_us"], _judged(splint["ratio"], MOST_TIMES)]]), "",
             _verdict("Together they take", splint["ratio"], MOST_TIMES, " times the pairs one by one"), "",
             *table(["ticks with every pair apart", "a pair, p50, µs", "p99, µs"],
                    [[splint["ticks_apart"], _judged(splint["apart_p50_us"], MOST_APART), splint["apart_p99_us"]]]), "",
             _verdict("A pair that is apart takes", splint["apart_p50_us"], MOST_APART, " µs"), "",
             "### In a world", "",
             "Four bodies in six pairs, voxels of 0.4 mm: two jaws that bite, a ball on the front teeth, a bar below the lower jaw. "
             "All but one tremble by a twentieth of a voxel. `World` and six queries are asked in turns.", "",
             *table(["question", "`World`, p50, µs", "p99, µs", "six queries, p50, µs", "p99, µs", "`World` / queries"],
                    [[name, run["p50_us"], run["p99_us"], run["one_by_one_p50_us"], run["one_by_one_p99_us"],
                      _judged(run["ratio"], MOST_TIMES)] for name, run in four.items()]), "",
             *(_verdict(f"`{name}` of the world takes", run["ratio"], MOST_TIMES, " times its queries") for name, run in four.items()), "",
             "A tick of balls of radius 1 on a grid:", "",
             *table(["bodies", "a tick, µs", "at most, µs"],
                    [[GRIDS[name][0], _judged(run["real_time"], GRIDS[name][1]), number(GRIDS[name][1]) if GRIDS[name][1] else "–"]
                     for name, run in grids.items()])]
    return lines


def _judged(value, most):
    """A number; bold where it is more than was promised."""
    return f"**{number(value)}**" if most is not None and value > most else number(value)


def _verdict(what, value, most, unit):
    """A sentence that says whether a promise holds."""
    if value <= most:
        return f"{what} {number(value)}{unit}: at most {number(most)} was promised."
    return f"**{what} {number(value)}{unit}; at most {number(most)} was promised.**"
