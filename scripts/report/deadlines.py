"""Chapter: by how much a query exceeds its deadline, every row that was measured, and how many queries do not count."""

from report.losses import NOT_EXPLAINED
from report.text import number, table

PROGRAMS = ["deadline_bench"]
PROGRAM = PROGRAMS[0]
QUANTILES = ("p50", "p99", "p99.9", "p99.99", "max")
# A query's tail is its own where it exceeds that of the empty loop by this factor, and by as many microseconds.
FACTOR, MICROSECONDS = 2, 20
# It is off its core more often than the loop where the part of its runs exceeds the loop's by this factor, and by PART.
PART = 0.001
# Contacts take no longer a leaf pair than this, with some room: 9 ns, and 42 a leaf (perf/NOTES.md, Contact points).
PAIR_US = 0.05
VERBS = {"leaf_pairs": "leaf pairs", "contacts": "contacts"}
SCENES = {
    "jaws": "jaws, five poses",
    "coarse_jaws": "jaws in voxels of 0.8 mm",
    "shells": "sphere in sphere",
    "peg": "peg in a hole",
    "plates": "plates",
    "inside": "sphere inside a sphere",
    "small_shells": "small sphere in sphere",
    "small_peg": "small peg in a hole",
    "small_plates": "small plates",
}


def scene_name(parts):
    return SCENES[parts[0]] + (f", {parts[1]} mm apart" if len(parts) > 1 else "")


def given(run):
    """The time that the queries of a run were given, µs, by its name."""
    return int(run.parts[0].removeprefix("within_").removesuffix("us"))


def row_name(run):
    return f"{VERBS[run.parts[1]]} of {scene_name(run.parts[2:])} within {given(run):,} µs"


def own_tail(run):
    """Returns the quantiles at which the query exceeds the empty loop by more than a shared machine explains."""
    return [q for q in QUANTILES[1:]
            if run[f"over_{q}_us"] > FACTOR * run[f"loop_{q}_us"] and run[f"over_{q}_us"] > run[f"loop_{q}_us"] + MICROSECONDS]


def why(run, own, worst_loop):
    """Why a query has a tail of its own."""
    in_time = run.parts[1] == "contacts" and 0 < run["complete"] < 1
    if in_time and run[f"over_{own[0]}_us"] <= PAIR_US * run["most_pairs"]:
        return "an answer that is complete just in time still makes contacts of its pairs, without a look at the clock"
    if set(own) <= {"p99.99", "max"} and run["over_max_us"] <= worst_loop:
        return f"{NOT_EXPLAINED}, but the worst loop of another row took {number(worst_loop)} µs"
    return NOT_EXPLAINED


def away_more(run):
    """Whether queries are off their core more often than loops."""
    query, loop = run["over_away"] / run["n"], run["loop_away"] / run["n"]
    return query > FACTOR * loop and query > loop + PART


def _tails(runs):
    """A verdict on what counts."""
    worst_loop = max(run["loop_max_us"] for run in runs)
    beyond = [f"{row_name(run)} ({', '.join(own)}: {why(run, own, worst_loop)})" for run in runs if (own := own_tail(run))]
    verdict = (f"Of what counts, in {len(runs) - len(beyond)} of {len(runs)} rows no quantile of the query exceeds that of the empty loop by more "
               f"than {FACTOR} times and {MICROSECONDS} µs: there the tail is the machine's. ")
    return verdict + (f"**These exceed it**: {'; '.join(beyond)}." if beyond else "No row exceeds it.")


def _away(runs):
    """A verdict on what does not count."""
    parts = {what: [100 * run[f"{what}_away"] / run["n"] for run in runs] for what in ("over", "loop")}
    more = [f"{row_name(run)} ({run['over_away']:,.0f} and {run['loop_away']:,.0f})" for run in runs if away_more(run)]
    return (f"Off their core for over {number(runs[0]['away_us'])} µs, and so in no quantile, were {number(min(parts['over']), 2)} to "
            f"{number(max(parts['over']), 2)} % of the queries of a row and {number(min(parts['loop']), 2)} to {number(max(parts['loop']), 2)} % of "
            "its loops: nothing here shows how late these were. "
            + (f"**Queries were away more often than loops**, {FACTOR} times and {100 * PART:g} % of all, "
               f"in {len(more)} of {len(runs)} rows: {'; '.join(more)}; {NOT_EXPLAINED}."
               if more else f"In no row were queries away more often than loops by over {FACTOR} times and {100 * PART:g} % of all."))


def chapter(results, _pictures):
    runs = sorted((run for run in results.runs(PROGRAM) if run.parts[0].startswith("within_")), key=given)
    rows = []
    for run in runs:
        own = own_tail(run)
        cells = []
        for q in QUANTILES:
            cell = f"{number(run[f'over_{q}_us'])}, {number(run[f'loop_{q}_us'])}"
            cells.append(f"**{cell}**" if q in own else cell)
        away = f"{run['over_away']:,.0f}, {run['loop_away']:,.0f}"
        rows.append([scene_name(run.parts[2:]), VERBS[run.parts[1]], f"{given(run):,}", *cells, f"{100 * run['complete']:.0f} %", run["most_pairs"],
                     f"{run['n'] - run['over_away']:,.0f}, {run['n'] - run['loop_away']:,.0f}", f"**{away}**" if away_more(run) else away])
    whole = results.runs(PROGRAM, "unbudgeted")
    found = "; ".join(f"{scene_name(run.parts[1:])} {number(run['p50_us'])} µs, {run['tests']:,.0f} tests, {run['pairs']:,.0f} leaf pairs"
                      for run in whole)
    medians = [run["over_p50_us"] for run in runs]
    writing = sum(run["most_pairs"] > 0 for run in runs)
    return ["## Deadlines kept", "",
            "Processor time of a query's thread beyond the time that it was given, beside a loop that only reads the clock until the same time has "
            f"passed; both in each cell, µs. What was off its core for over {number(runs[0]['away_us'])} µs is *away*, and in no quantile; "
            "interrupts count. *n* is what is left. `slab`, one worker. "
            f"*Complete* are answers that came to their end, *pairs* the most leaf pairs of an answer; {writing} of {len(runs)} rows write some.", "",
            *table(["scene", "asks for", "given, µs", *QUANTILES, "complete", "pairs", "n", "away"], rows), "",
            f"In the median a query ends {number(min(medians), 2)} to {number(max(medians), 2)} µs after its deadline. {_tails(runs)}", "",
            _away(runs), "",
            f"Without a deadline, in the median: {found}."]
