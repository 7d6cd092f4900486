#!/usr/bin/python3
"""Counts the instructions of ten fixed queries, and of ticks of two scenes with one fixed body, with callgrind, and compares them
with those that perf/query_instructions.json keeps: a count that is over 1 % more or less fails. Counts do not depend on load, so
this notices what no clock would.

Counted is what the tests run on, preset test with its assertions, one worker on AVX2. Where compiler or flags are not those of
the counts that are kept, or valgrind or AVX2 is missing, nothing can be compared: that is said, and the exit code is 77; with
IST_REQUIRE_ALL=1 it is 1.

    scripts/query_instructions.py                    builds, counts and compares, as ctest does
    scripts/query_instructions.py --update           keeps the new counts, and tells what has changed
    scripts/query_instructions.py --program FILE     counts a program that is built already"""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from machine import ROOT, build

LIMIT = 0.01
SKIPPED = 77


class NotComparable(Exception):
    """Raised where there is nothing to compare, which is no failure."""


def run(program, folder):
    """Returns the program's output under callgrind, which leaves a file per query in the folder."""
    if shutil.which("valgrind") is None:
        raise NotComparable("valgrind is not installed: scripts/setup.sh --package does that")
    if not pathlib.Path(program).exists():
        raise NotComparable(f"{program} is not built. It needs valgrind's headers when cmake configures")
    ran = subprocess.run(
        ["valgrind", "--tool=callgrind", "--instr-atstart=no", f"--callgrind-out-file={folder}/out", program],
        capture_output=True, text=True, check=False)
    if ran.returncode == SKIPPED:
        said = [line for line in ran.stderr.splitlines() if not line.startswith("==")]
        raise NotComparable(" ".join(said))
    if ran.returncode != 0:
        raise ValueError(f"{program} failed:\n{ran.stderr}")
    return ran.stdout


def counts_in(folder):
    """Instructions by query, from the files that callgrind left."""
    counts = {}
    for file in pathlib.Path(folder).glob("out.*"):
        text = file.read_text()
        name = re.search(r"^desc: Trigger: Client Request: (.+)$", text, re.MULTILINE)
        total = re.search(r"^totals: (\d+)$", text, re.MULTILINE)
        if name and total:
            counts[name.group(1)] = int(total.group(1))
    return counts


def join(printed, counts):
    """Returns the record of one run: compiler and flags, and the counts of each query."""
    context, queries = {}, []
    for line in printed.splitlines():
        if re.match(r"(compiler|flags|ticks): ", line):
            key, value = line.split(": ", 1)
            context[key] = value
            continue
        name, found, tests = line.split()
        if counts.get(name, 0) < 1000:
            raise ValueError(f"{name}: {counts.get(name, 0)} instructions: nothing was counted")
        queries.append({"name": name, "instructions": counts[name], "found": int(found), "sphere_tests": int(tests)})
    return {"context": context, "queries": queries}


def count(program):
    with tempfile.TemporaryDirectory() as folder:
        printed = run(program, folder)
        return join(printed, counts_in(folder))


def require_comparable(kept, new):
    for key, value in kept["context"].items():
        if new["context"][key] != value:
            raise NotComparable(f"the {key} of the counts that are kept: {value}\nthe {key} here: "
                                f"{new['context'][key]}")


def compare(kept, new):
    """Returns a line per query, and the number of queries beyond the limit, with another answer, or on one side only."""
    before = {query["name"]: query for query in kept["queries"]}
    after = {query["name"]: query for query in new["queries"]}
    lines, beyond = [], 0
    for name in list(before) + [name for name in after if name not in before]:
        if name not in before or name not in after:
            beyond += 1
            lines.append(f"{name:<34} is only {'here' if name in after else 'among the counts that are kept'}")
            continue
        old, now = before[name]["instructions"], after[name]["instructions"]
        line = f"{name:<34} {old:>12} {now:>12}  {now / old:6.4f}"
        flaws = [f"{what} {before[name][what]} -> {after[name][what]}" for what in ("found", "sphere_tests")
                 if before[name][what] != after[name][what]]
        if abs(now - old) > LIMIT * old:
            flaws.append(f"{'MORE' if now > old else 'FEWER'} by over {LIMIT:.0%}")
        if flaws:
            beyond += 1
            line += "  " + ", ".join(flaws)
        lines.append(line)
    return lines, beyond


def main(program, baseline, update=False):
    try:
        new = count(program)
        kept = json.loads(baseline.read_text()) if baseline.exists() else None
        if kept is None and not update:
            raise NotComparable(f"{baseline} is not there: --update makes it")
        if not update:
            require_comparable(kept, new)
    except NotComparable as reason:
        print(f"query_instructions: nothing to compare: {reason}", file=sys.stderr)
        return 1 if os.environ.get("IST_REQUIRE_ALL") == "1" else SKIPPED
    except ValueError as error:
        print(f"query_instructions: {error}", file=sys.stderr)
        return 1
    if kept is not None:
        lines, beyond = compare(kept, new)
        print("\n".join([f"{'query':<34} {'kept':>12} {'now':>12}  ratio"] + lines))
    if update:
        baseline.write_text(json.dumps(new, indent=2) + "\n")
        print(f"{baseline} is written")
        return 0
    if beyond:
        print(f"query_instructions: {beyond} of the queries above changed. If that is meant, "
              "scripts/query_instructions.py --update keeps the new counts; say in perf/NOTES.md why", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__, usage=argparse.SUPPRESS, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--update", action="store_true", help=argparse.SUPPRESS)
    options.add_argument("--program", help=argparse.SUPPRESS)
    given = options.parse_args()
    if not given.program:
        build("test", "query_instructions", needs=["--tests", "--package"])
    sys.exit(main(given.program or ROOT / "build/test/tests/query_instructions", ROOT / "perf/query_instructions.json", given.update))
