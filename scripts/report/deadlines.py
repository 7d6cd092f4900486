"""Chapter: by how much a query exceeds its deadline, every row that was measured."""

from report.text import number, table

PROGRAMS = ["deadline_bench"]
PROGRAM = PROGRAMS[0]
QUANTILES = ("p50", "p99", "p99.9", "p99.99", "max")
# A query's tail is its own where it exceeds that of the empty loop by this factor, and by as many microseconds.
FACTOR, MICROSECONDS = 2, 20
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


def own_tail(run):
    """Returns the quantiles at which the query exceeds the empty loop by more than a shared machine explains."""
    return [q for q in QUANTILES[1:]
            if run[f"over_{q}_us"] > FACTOR * run[f"loop_{q}_us"] and run[f"over_{q}_us"] > run[f"loop_{q}_us"] + MICROSECONDS]


def chapter(results, _pictures):
    runs = [run for given in ("within_100us", "within_1000us") for run in results.runs(PROGRAM, given)]
    rows, beyond, writing = [], [], 0
    for run in runs:
        given, verb, scene = run.parts[0].removeprefix("within_").removesuffix("us"), run.parts[1], scene_name(run.parts[2:])
        own = own_tail(run)
        writing += run["most_pairs"] > 0
        cells = []
        for q in QUANTILES:
            cell = f"{number(run[f'over_{q}_us'])}, {number(run[f'loop_{q}_us'])}"
            cells.append(f"**{cell}**" if q in own else cell)
        if own:
            beyond.append(f"{VERBS[verb]} of {scene} within {given} µs ({', '.join(own)})")
        rows.append([scene, VERBS[verb], f"{int(given):,}", *cells, f"{100 * run['complete']:.0f} %", run["most_pairs"], run["n"]])
    whole = results.runs(PROGRAM, "unbudgeted")
    found = "; ".join(f"{scene_name(run.parts[1:])} {number(run['p50_us'])} µs, {run['tests']:,.0f} tests, {run['pairs']:,.0f} leaf pairs"
                      for run in whole)
    medians = [run["over_p50_us"] for run in runs]
    verdict = (f"In {len(runs) - len(beyond)} of {len(runs)} rows no quantile of the query exceeds that of the empty loop by more than {FACTOR} times and "
               f"{MICROSECONDS} µs. " + (f"**These do**: {'; '.join(beyond)}." if beyond else "So all tails are the machine's."))
    return ["## Deadlines kept", "",
            "Processor time of a query's thread beyond the time that it was given, beside a loop that only reads the clock until the same time has "
            "passed; both in each cell, µs. What was off its core for over 2 µs does not count, interrupts do. `slab`, one worker. "
            f"*Complete* are answers that came to their end, *pairs* the most leaf pairs of an answer; {writing} of {len(runs)} rows write some.", "",
            *table(["scene", "asks for", "given, µs", *QUANTILES, "complete", "pairs", "n"], rows), "",
            f"In the median a query ends {number(min(medians), 2)} to {number(max(medians), 2)} µs after its deadline. {verdict}", "",
            f"Without a deadline, in the median: {found}."]
