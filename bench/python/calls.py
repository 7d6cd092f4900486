#!/usr/bin/env python3
"""Times calls from Python beside the same calls from C, in turns, and prints medians: what a call costs more, and how much of C's
poses a second rows reach. Given a page, writes the table there.

    IST_LIBRARY=build/release/src/package/libist.so PYTHONPATH=src/python bench/python/calls.py [docs/performance.md]

From the project's root. Needs gcc, numpy, a library that was built (scripts/setup.sh --python; cmake --preset release; cmake --build
--preset release), and the fixed loop (cmake --preset bench; cmake --build --preset bench --target fixed_loop).
"""
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

CALLS, POSES, ROUNDS = 4000, 20_000, 7
# What was promised: a call takes so much more, µs, and rows reach so much of C's poses a second.
MOST_MORE, LEAST_SHARE = 3, 0.95
# The lower jaw far below, where a call is nearly nothing, and about to touch.
HEIGHTS = {-500.0: "far apart", -1.5: "near"}


def in_c(program, trees):
    done = subprocess.run([program, *trees, str(CALLS), str(POSES)], capture_output=True, text=True, check=True)
    return {line.split()[0]: float(line.split()[1]) for line in done.stdout.splitlines()}


def in_python(query):
    pose = np.eye(4)
    pose[:3, 3] = 0.1, 0.2, 0
    pairs, contacts, found = np.empty(4096, ist.LEAF_PAIR), np.empty(32, ist.CONTACT), {}
    verbs = {
        "intersects": lambda: query.intersects(pose),
        "leaf_pairs": lambda: query.leaf_pairs(pose, out=pairs),
        "contacts": lambda: query.contacts(pose, out=contacts),
    }
    for name, height in itertools.product(verbs, HEIGHTS):
        verb, pose[2, 3], times = verbs[name], height, []
        for i in range(-CALLS // 10, CALLS):
            pose[0, 3] = 0.1 + 1e-9 * i
            begin = time.perf_counter_ns()
            verb()
            if i >= 0:
                times.append(time.perf_counter_ns() - begin)
        found[f"{name}_at_{height:.1f}"] = statistics.median(times)
    poses = np.tile(pose, (POSES, 1, 1))
    poses[:, 2, 3] = -2.5 * np.arange(POSES) / POSES
    out = np.empty(POSES, ist.ROW)
    begin = time.perf_counter()
    query.rows(poses, tolerance=0.01, threads=2, out=out)
    found["rows"] = POSES / (time.perf_counter() - begin)
    return found


def main():
    library = os.environ.get("IST_LIBRARY")
    if not library or not pathlib.Path(library).is_file():
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        program, trees = f"{folder}/calls", [f"{folder}/upper.ist", f"{folder}/lower.ist"]
        subprocess.run(["gcc", "-O2", "-std=gnu11", f"-I{ROOT}/src", f"{ROOT}/bench/python/calls.c", library,
                        f"-Wl,-rpath,{pathlib.Path(library).resolve().parent}", "-o", program], check=True)
        bodies = [ist.build(jaw, 0.4) for jaw in ist.jaws()]
        for body, name in zip(bodies, trees):
            body.save(name)
        query = ist.Query(*bodies)
        context = {"load_avg": os.getloadavg(), "loop_before": fixed_loop()}
        rounds = [(in_c(program, trees), in_python(query)) for _ in range(ROUNDS)]
        context |= {"load_after": os.getloadavg()[0], "loop_after": fixed_loop()}
    lines = ["| call with `out=` | bodies | C, µs | Python, µs | more, µs |", "|---|---|---|---|---|"]
    dearest = 0
    for height, name in itertools.product(HEIGHTS, ("intersects", "leaf_pairs", "contacts")):
        key = f"{name}_at_{height:.1f}"
        c, python = (statistics.median(each[i][key] for each in rounds) / 1e3 for i in (0, 1))
        more = statistics.median(each[1][key] - each[0][key] for each in rounds) / 1e3
        lines.append(f"| `{name}` | {HEIGHTS[height]} | {c:.2f} | {python:.2f} | {bold(more, more > MOST_MORE, '.2f')} |")
        dearest = max(dearest, more)
    c, python = (statistics.median(each[i]["rows"] for each in rounds) for i in (0, 1))
    share = statistics.median(each[1]["rows"] / each[0]["rows"] for each in rounds)
    lines += ["", f"A call was to take {MOST_MORE} µs more than in C at most. "
              + (f"**Up to {dearest:.1f} µs more were measured.**" if dearest > MOST_MORE else "It does."), "",
              f"`rows` on two threads: {c:,.0f} poses a second in C, {python:,.0f} in Python: "
              f"{bold(100 * share, share < LEAST_SHARE, '.0f')} % (promised: {100 * LEAST_SHARE:.0f}).", ""]
    lines.append(stamp(*here(), "calls.py", machine_state(context)))
    show("\n".join(lines) + "\n")


def bold(value, is_missed, digits):
    """A number, bold where it misses what was promised."""
    return f"**{value:{digits}}**" if is_missed else f"{value:{digits}}"


def show(text):
    """Prints the table, or writes it into a page between its marks."""
    if len(sys.argv) < 2:
        return print(text, end="")
    page = pathlib.Path(sys.argv[1])
    before, begin, rest = page.read_text().partition("<!-- python table -->\n")
    _, end, after = rest.partition("<!-- end of python table -->")
    if not begin or not end:
        sys.exit(f"{page} has no place for the table: <!-- python table --> and its end")
    page.write_text(before + begin + text + end + after)


if __name__ == "__main__":
    main()
