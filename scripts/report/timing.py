"""Tables and plots of deadlines, of the loop, of many bodies, of sweeps and of instructions, and the runs of all programs."""

import json
import pathlib

from report.draw import LOG, panel, plot
from report.tables import Table, is_loss, markdown, number, row, runs

QUANTILES = ("p50", "p99", "p99.9", "p99.99", "max")
# A query's tail is its own if it exceeds the empty loop's by this factor and by as many microseconds. A query is away more often than
# the loop if its share exceeds the loop's by this factor and by this part of all.
FACTOR, MICROSECONDS, PART = 2, 20, 0.001
VERBS = {"leaf_pairs": "leaf pairs", "contacts": "contacts"}
SCENES = {"jaws": "jaws, five poses", "coarse_jaws": "jaws in voxels of 0.8 mm", "shells": "sphere in sphere", "peg": "peg in a hole",
          "plates": "plates", "inside": "sphere inside a sphere", "small_shells": "small sphere in sphere", "small_peg": "small peg in a hole",
          "small_plates": "small plates"}


def scene(parts):
    return SCENES[parts[0]] + (f", {parts[1]} mm apart" if len(parts) > 1 else "")


def given(run):
    """The time that the queries of a run were given, µs."""
    return int(run.parts[0].removeprefix("within_").removesuffix("us"))


def both(form, left, right):
    return lambda r: f"{form(r, left)}, {form(r, right)}"


def own_tail(quantile):
    def rule(r):
        over, loop = r[f"over_{quantile}_us"], r[f"loop_{quantile}_us"]
        return quantile != "p50" and over > FACTOR * loop and over > loop + MICROSECONDS
    return rule


def away_more(r):
    query, loop = r["over_away"] / r["n"], r["loop_away"] / r["n"]
    return query > FACTOR * loop and query > loop + PART


# Each kind of loop: its words, colour and mark.
LOOPS = {
    "loop/1": ("the loop, 1 worker", "#1b9e77", "D"),
    "loop/2": ("the loop, 2 workers", "#7570b3", "^"),
    "bare/clock": ("nothing, by the loop's clock", "#d95f02", "o"),
    "bare/timer": ("nothing, a timer at the loop's priority", "#888888", "s"),
    "bare/plain": ("nothing, an ordinary thread's sleep", "#e7298a", "*"),
}
CONDITIONS = {"idle": "idle", "noisy": "beside a noisy neighbour"}


def loop_table(what, kinds):
    return Table("loop_bench", lambda results, program: [
        results.runs(program, *kind.split("/"), condition)[0] for kind in LOOPS if kind.startswith(kinds) for condition in CONDITIONS], [
        ("", lambda r: LOOPS["/".join(r.parts[:2])][0] + (", **without what the system denied**" if r.get("denied") else "")),
        ("machine", lambda r: CONDITIONS[r.parts[2]]),
        *((f"{quantile}, µs", f"{what}_{quantile}_us") for quantile in ("p50", "p90", "p99", "p99.9", "max")),
        ("missed", "missed", lambda r: r["missed"] > 0), ("ticks", "ticks")])


# The goals: how many times the same pairs one by one at most, and how many µs at most.
MOST_TIMES, MOST_APART, MOST_AT_REST = 1.15, 2, 20
# Of a thousand balls: ms and MB.
MOST_THOUSAND, MOST_MEGABYTES = 100, 200
GRIDS = {"a_pair_apart": ("apart", MOST_APART), "a_pair_near_and_not_prepared": ("whose balls overlap, without a query", None),
         "hundred_at_rest": ("none near", MOST_AT_REST), "hundred_moving": ("none near", None)}


def together(head):
    return head, "ratio", lambda r: r["ratio"] > MOST_TIMES


def in_world(rows):
    pairs = f"{rows[0]['pairs']:.0f}"
    return [("question", 2), ("`World`, p50, µs", "p50_us"), ("p99, µs", "p99_us"), (f"{pairs} queries, p50, µs", "one_by_one_p50_us"),
            ("p99, µs", "one_by_one_p99_us"), together("`World` / queries")]


def thousand(results, program):
    return results.runs(program, "world", "thousand_balls") if results.has(program, "world", "thousand_balls") else []


def sweep_rates(results, program):
    run, = results.runs(program, "sweep", "rates")
    threads = sorted((key for key in run if key.startswith("threads_")), key=lambda key: int(key.split("_")[1]))
    ways = {key: f"`ist sweep`, {key.split('_')[1]} thread{'s' if key != 'threads_1' else ''}" for key in threads}
    ways |= {"loop_in_c": "a loop over the single calls in C", "loop_in_python": "the same loop in Python"}
    return [row(key, way=way, rate=run[key], times=run[key] / run["threads_1"],
                loses=is_loss(run["threads_1"] / run[key]) if "loop" in key else key != "threads_1" and is_loss(run[key] / before))
            for (key, way), before in zip(ways.items(), [0, *(run[key] for key in ways)])]


TABLES = {
    "deadlines": Table("deadline_bench", lambda results, program: sorted(
        (run for run in results.runs(program) if run.parts[0].startswith("within_")), key=given), [
        ("scene", lambda r: scene(r.parts[2:])), ("asks for", lambda r: VERBS[r.parts[1]]), ("given, µs", given),
        *((q, both(lambda r, key: number(r[key]), f"over_{q}_us", f"loop_{q}_us"), own_tail(q)) for q in QUANTILES),
        ("complete", lambda r: f"{100 * r['complete']:.0f} %"), ("pairs", "most_pairs"),
        ("n", both(lambda r, key: number(r["n"] - r[key]), "over_away", "loop_away")),
        ("away", both(lambda r, key: number(r[key]), "over_away", "loop_away"), away_more)]),
    "without a deadline": Table("deadline_bench", runs("unbudgeted"), [
        ("scene", lambda r: scene(r.parts[1:])), ("median, µs", "p50_us"), ("tests", "tests"), ("leaf pairs", "pairs")]),
    "lateness": loop_table("late", ("loop", "bare")),
    "execution": loop_table("execution", ("loop",)),
    "pairs of a tick": Table("loop_bench", runs("bodies"), [
        ("ticks", "ticks"), ("all pairs of a tick, p50, µs", "together_p50_us"), ("p99, µs", "together_p99_us"),
        ("one by one, p50, µs", "one_by_one_p50_us"), ("p99, µs", "one_by_one_p99_us"), together("together / one by one")]),
    "pairs apart": Table("loop_bench", runs("bodies"), [
        ("ticks with every pair apart", "ticks_apart"), ("a pair, p50, µs", "apart_p50_us", lambda r: r["apart_p50_us"] > MOST_APART),
        ("p99, µs", "apart_p99_us")]),
    "world": Table("world_bench", runs("world", "four_bodies"), in_world),
    "grid": Table("world_bench", runs("world", keep=lambda r: r.parts[1] in GRIDS), [
        ("bodies", lambda r: f"{r['bodies']:.0f} bodies, {GRIDS[r.parts[1]][0]}, {r['moved']:.0f} moving"),
        ("a tick, µs", "real_time", lambda r: r["real_time"] > (GRIDS[r.parts[1]][1] or float("inf"))),
        ("at most, µs", lambda r: GRIDS[r.parts[1]][1] or "–")]),
    "a thousand balls by threads": Table("world_bench", thousand, [
        ("threads", "threads"), ("near pairs", "near"), ("that intersect", "touching"),
        ("from the first body to the first answer, ms", "real_time", lambda r: r["real_time"] > MOST_THOUSAND),
        ("reserved, MB", "megabytes", lambda r: r["megabytes"] > MOST_MEGABYTES)]),
    "sweeps": Table("sweep_bench", sweep_rates, [
        ("way", "way"), ("poses a second", "rate", lambda r: r["loses"]), ("times one thread of `ist sweep`", lambda r: f"{r['times']:.2f}")]),
}


def tail(run, what):
    """Times, and the part of all ticks that were longer: from the last time that all exceed to the longest tick."""
    count, head = run[what + "_count"], what + "_upto_"
    points = sorted((float(key[len(head):-2]), 1 - value / count) for key, value in run.items() if key.startswith(head))
    return [*[(time, 1) for time, part in points if part == 1][-1:],
            *((time, part) for time, part in points if 0 < part < 1 and time < run[what + "_max_us"]), (run[what + "_max_us"], 1 / count)]


def loop_plot(results, what, kinds, label, deadline=()):
    shown = [(kind, condition, results.runs("loop_bench", *kind.split("/"), condition)[0]) for kind in kinds for condition in CONDITIONS]
    counts = sorted(int(run[what + "_count"]) for _, _, run in shown)

    def same_limits(_, all_axes):
        low = min(axes.get_xlim()[0] for axes in all_axes), min(axes.get_ylim()[0] for axes in all_axes)
        high = max(axes.get_xlim()[1] for axes in all_axes)
        for axes in all_axes:
            axes.set(xlim=(low[0], high), ylim=(low[1], 1.5))
    return {"n": f"n = {counts[0]:,} to {counts[-1]:,} ticks a line, in buckets of 1/32 of the time; the last point of a line is its longest tick",
            "then": same_limits, "panels": [panel(
                [(*zip(*tail(run, what)), {"color": LOOPS[kind][1], "marker": LOOPS[kind][2], "label": LOOPS[kind][0], "markersize": 3})
                 for kind, at, run in shown if at == condition], [("axvline", at, {"color": "#555555", "linestyle": ":", "label": "the period"})
                                                                  for at in deadline], {"fontsize": 6.5}, **LOG,
                xlabel=label, ylabel="part of all ticks (1 - CDF)", title=title.capitalize()) for condition, title in CONDITIONS.items()]}


@plot("loop_bench")
def loop_late(results):
    return loop_plot(results, "late", LOOPS, "began late by more than, µs")


@plot("loop_bench")
def loop_execution(results):
    period = results.runs("loop_bench", "loop")[0]["period_us"]
    return loop_plot(results, "execution", [kind for kind in LOOPS if kind.startswith("loop")], "took more than, µs", [period])


def instructions():
    """The lines of the table of instructions, which scripts/query_instructions.py counts and each run of the tests repeats."""
    counted = json.loads((pathlib.Path(__file__).parents[2] / "perf/query_instructions.json").read_text())
    rows = sorted(counted["queries"], key=lambda query: query["name"].startswith("ticks/"))
    return [*markdown(["query", "instructions", "sphere tests", "instructions a test"], [
        [f"`{q['name']}`", q["instructions"], q["sphere_tests"] or "–",
         q["instructions"] / q["sphere_tests"] if q["sphere_tests"] and not q["name"].startswith("ticks/") else "–"] for q in rows]), "",
        "Repeated by the test `QueryInstructions`.", "", f"Compiled by {counted['context']['compiler']}, `{counted['context']['flags']}`."]


def machine(context):
    caches = ", ".join(f"L{c['level']} {c['type'].lower()} {c['size'] // 1024} KiB" for c in context["caches"])
    return (f"{context['processor']}, {context['num_cpus']} cores at {context['mhz_per_cpu']} MHz; {caches}. {context['compiler']}; "
            f"`{context['flags']}`.")


def made_with(results, programs):
    """The lines that name each machine, and the table of the runs."""
    contexts = {program: results.context(program) for program in programs}
    machines = list(dict.fromkeys(map(machine, contexts.values())))
    return [*(f"{place}. {text}" for place, text in enumerate(machines, 1)), "", *markdown(
        ["program", "machine", "commit", "begun", "seconds", "load when it began (1, 5, 15 minutes)", "fixed loop before and after, µs"],
        [[f"`{program}`", machines.index(machine(c)) + 1, c["commit"], c["date"][:16].replace("T", " "), float(c["seconds"]),
          ", ".join(f"{load:.1f}" for load in c["load_avg"]), f"{c['loop_before']}, {c['loop_after']}"] for program, c in contexts.items()])]
