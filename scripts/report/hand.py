"""Tables of two jaws that a hand presses together: how far gap and force are off, and the time of a tick."""

from report.results import Run
from report.tables import Table, number

PROGRAM = "hand_bench"
PHASES = {"rests": "at rest, at most 1 N", "pressed": "pressed, at most 5 N", "aside": "3 mm aside and back", "tilts": "3° tilted and back",
          "all": "the whole press"}
# The goals: µs of a tick at rest in the median, and of 999 of 1,000 ticks of a press by workers.
AT_REST, SLOW = 50, {"1": 200, "2": 120}
STOPPED = 1e-3  # the part of the ticks that may be held or halved


def keeper(r):
    """What keeps the jaws apart: `contact`, or `springs` with their voxels."""
    return f"`springs`, {r.parts[3]} mm" if r.parts[2] == "springs" else "`contact`"


def errors(results, program):
    """The runs of accuracy, with the times of a tick of one worker."""
    times = {tuple(run.parts[1:4]): run for run in results.runs(program, "ticks") if run.parts[4] == "1"}
    rows = []
    for run in results.runs(program, "accuracy"):
        of = times[*run.parts[1:3], run.parts[3]]
        rows.append(Run(run | {f"tick_{q}": of[f"all_{q}_us"] for q in ("p50", "p99.9")}))
    return rows


def phases(results, program):
    """A row for each part of each press, with the times of both numbers of workers."""
    runs = results.runs(program, "ticks")
    both = {(*run.parts[1:4],): {} for run in runs}
    for run in runs:
        both[(*run.parts[1:4],)][run.parts[4]] = run
    rows = []
    for of in both.values():
        for phase in PHASES:
            row = Run(of["1"] | {"phase": phase})
            for workers, run in of.items():
                row |= {f"{workers}:{name.removeprefix(phase + '_')}": value for name, value in run.items() if name.startswith(phase + "_")}
            rows.append(Run(row))
    return rows


def micrometres(key):
    return lambda r: number(1e3 * r[key]) if r[key] else "0"


def slow(workers):
    return lambda r: r["phase"] == "all" and r[f"{workers}:p99.9_us"] > SLOW[workers]


def stopped(r):
    return r["1:held"] + r["1:halved"] > STOPPED * r["1:ticks"]


def passes(key):
    return lambda r: r[key] < 0


TABLES = {
    "hand": Table(PROGRAM, errors, [
        ("jaws", 1), ("kept apart by", keeper), ("gap at rest, µm", micrometres("gap_mm"), passes("gap_mm")), ("force there, N", "rest_force_N"),
        ("least gap, µm", micrometres("least_gap_mm"), passes("least_gap_mm")), ("force off by, median, N", "off_p50_N"), ("largest, N", "off_max_N"),
        ("direction off by, median, °", "angle_p50"), ("largest, °", "angle_max"), ("largest change in a tick, N", "change_N"),
        ("tick, median, µs", "tick_p50"), ("p99.9, µs", "tick_p99.9")]),
    "ticks of a press": Table(PROGRAM, phases, [
        ("jaws", 1), ("kept apart by", keeper), ("part", lambda r: PHASES[r["phase"]]),
        ("1 worker: p50, µs", "1:p50_us", lambda r: r["phase"] == "rests" and r["1:p50_us"] > AT_REST), ("p99, µs", "1:p99_us"),
        ("p99.9, µs", "1:p99.9_us", slow("1")), ("max, µs", "1:max_us"), ("2 workers: p50, µs", "2:p50_us"), ("p99, µs", "2:p99_us"),
        ("p99.9, µs", "2:p99.9_us", slow("2")), ("max, µs", "2:max_us"), ("ticks", "1:ticks"), ("steps a tick", "1:steps"),
        ("held, halved", lambda r: f"{number(r['1:held'])}, {number(r['1:halved'])}", stopped), ("searched afresh", "1:searched")]),
}
