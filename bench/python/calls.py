#!/usr/bin/env python3
"""Times calls from Python beside the same calls from C, in turns, call by call, and prints medians: what a call costs more, and how
much of C's poses a second rows reach. Given a page, writes the table there.

    IST_LIBRARY=build/release/src/package/libist_loop.so PYTHONPATH=src/python bench/python/calls.py [docs/performance.md]

From the project's root. Needs gcc, numpy, a library that was built (scripts/setup.sh --python; cmake --preset release; cmake --build
--preset release), and the fixed loop (cmake --preset bench; cmake --build --preset bench --target fixed_loop).
"""
import ctypes
import itertools
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import ist

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from report.figures import here, machine_state, stamp  # noqa: E402  after its folder is known
from report.runner import fixed_loop  # noqa: E402
from report.tables import fill  # noqa: E402

CALLS, POSES, ROUNDS = 1000, 20_000, 31
# What was promised: a call takes so much more, µs, and rows reach so much of C's poses a second.
MOST_MORE, LEAST_SHARE = 3, 0.95
# The lower jaw far below, where a call is nearly nothing, and about to touch.
HEIGHTS = {-500.0: "far apart", -1.5: "near"}
VERBS = ("intersects", "leaf_pairs", "contacts")


def calls_in_python(query, pose):
    """Makes a call of each verb, and one of nothing, whose time is that of the clock and of the call of a function."""
    pairs, contacts = np.empty(4096, ist.LEAF_PAIR), np.empty(32, ist.CONTACT)
    return {
        "nothing": lambda: None,
        "intersects": lambda: query.intersects(pose),
        "leaf_pairs": lambda: query.leaf_pairs(pose, out=pairs),
        "contacts": lambda: query.contacts(pose, out=contacts),
    }


def times_of(query, name, height, in_c):
    """Makes calls of a verb in C and in Python, in turns, one by one. Returns the medians in C, in Python and of what Python's takes more, ns."""
    pose, by_column = np.eye(4), np.eye(4)
    pose[:3, 3] = 0.1, 0.2, height
    call, c, handle = calls_in_python(query, pose)[name], getattr(in_c, f"time_of_{name}"), query._need()
    times = []
    for i in range(-CALLS // 10, CALLS):
        pose[0, 3] = 0.1 + 1e-9 * i
        by_column[...] = pose.T
        # Who comes second finds what the first one left in the caches; so they change places.
        first = c(handle, by_column.ctypes.data) if i % 2 else None
        begin = time.perf_counter_ns()
        call()
        python = time.perf_counter_ns() - begin
        times.append((c(handle, by_column.ctypes.data) if first is None else first, python))
    in_order = times[CALLS // 10:]
    return tuple(map(statistics.median, zip(*((c, python, python - c) for c, python in in_order))))


def rows_of(query, in_c):
    """Poses a second, in C and in Python."""
    poses = np.tile(np.eye(4), (POSES, 1, 1))
    poses[:, :2, 3] = 0.1, 0.2
    poses[:, 2, 3] = -2.5 * np.arange(POSES) / POSES
    by_column, out = np.ascontiguousarray(poses.transpose(0, 2, 1)), np.empty(POSES, ist.ROW)
    c = 1e9 * POSES / in_c.time_of_rows(query._need(), by_column.ctypes.data, POSES)
    begin = time.perf_counter()
    query.rows(poses, tolerance=0.01, threads=2, out=out)
    return c, POSES / (time.perf_counter() - begin)


def library_in_c(library, folder):
    """Compiles calls.c beside the library that Python uses, too."""
    made = f"{folder}/calls.so"
    subprocess.run(["gcc", "-O2", "-std=gnu11", "-shared", "-fPIC", f"-I{ROOT}/src", f"{ROOT}/bench/python/calls.c", library,
                    f"-Wl,-rpath,{pathlib.Path(library).resolve().parent}", "-o", made], check=True)
    in_c = ctypes.CDLL(made)
    for name in ("nothing", *VERBS):
        function = getattr(in_c, f"time_of_{name}")
        function.restype, function.argtypes = ctypes.c_double, [ctypes.c_void_p, ctypes.c_void_p]
    in_c.time_of_rows.restype, in_c.time_of_rows.argtypes = ctypes.c_double, [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t]
    return in_c


def main():
    library = os.environ.get("IST_LIBRARY")
    if not library or not pathlib.Path(library).is_file():
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        in_c = library_in_c(library, folder)
        query = ist.Query(*(ist.build(jaw, 0.4) for jaw in ist.jaws()))
        context = {"load_avg": os.getloadavg(), "loop_before": fixed_loop()}
        keys = list(itertools.product(("nothing", *VERBS), HEIGHTS))
        rounds = [{key: times_of(query, *key, in_c) for key in keys} | {"rows": rows_of(query, in_c)} for _ in range(ROUNDS)]
        context |= {"load_after": os.getloadavg()[0], "loop_after": fixed_loop()}
    lines = ["| call with `out=` | bodies | C, µs | Python, µs | more, µs |", "|---|---|---|---|---|"]
    clock = [statistics.median(each["nothing", height][which] for each in rounds for height in HEIGHTS) for which in range(3)]
    dearest, missed = 0, []
    for height, name in itertools.product(HEIGHTS, VERBS):
        c, python, more = ((statistics.median(each[name, height][which] for each in rounds) - clock[which]) / 1e3 for which in range(3))
        lines.append(f"| `{name}` | {HEIGHTS[height]} | {c:.2f} | {python:.2f} | {bold(more, more > MOST_MORE, '.2f')} |")
        dearest = max(dearest, more)
        missed += [HEIGHTS[height]] if more > MOST_MORE else []
    c, python = (statistics.median(each["rows"][i] for each in rounds) for i in (0, 1))
    share = statistics.median(each["rows"][1] / each["rows"][0] for each in rounds)
    lines += ["", f"A call was to take {MOST_MORE} µs more than in C at most. "
              + (f"**Up to {dearest:.1f} µs more were measured**, with bodies {' and '.join(dict.fromkeys(missed))}: "
                 "the parts of that time were not measured." if missed else "It does."), "",
              f"`rows` on two threads: {c:,.0f} poses a second in C, {python:,.0f} in Python: "
              f"{bold(100 * share, share < LEAST_SHARE, '.0f')} %, the median of {ROUNDS} rounds (promised: {100 * LEAST_SHARE:.0f}).", ""]
    lines.append(stamp(*here(), "calls.py", machine_state(context)))
    show("\n".join(lines))


def bold(value, is_missed, digits):
    """A number, bold where it misses what was promised."""
    return f"**{value:{digits}}**" if is_missed else f"{value:{digits}}"


def show(text):
    """Prints the table, or writes it into a page between its marks."""
    if len(sys.argv) < 2:
        return print(text)
    fill(pathlib.Path(sys.argv[1]), "python table", text)


if __name__ == "__main__":
    main()
