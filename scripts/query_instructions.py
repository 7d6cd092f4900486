#!/usr/bin/python3
"""Counts the instructions of ten fixed queries, and of ticks of two scenes with one fixed body, with callgrind, and compares them with those that
perf/query_instructions.json keeps. A count that differs by over 1 % fails. Counts do not depend on load, so this notices changes that no clock would.

The program is built like the tests, by preset test with its assertions, and uses one worker on AVX2. The counts cannot be compared if compiler or
flags differ, or if valgrind or AVX2 is missing. The exit code is then 77; with IST_REQUIRE_ALL=1 it is 1.

    scripts/query_instructions.py                    builds, counts and compares, like ctest
    scripts/query_instructions.py --update           keeps the new counts, and shows the changes
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
    """Raised if the counts cannot be compared. That is not a failure."""


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
    """Returns the instructions by query, from the files that callgrind left."""
    query = re.compile(r"^desc: Trigger: Client Request: (.+)$[\s\S]*^totals: (\d+)$", re.MULTILINE)
    found = (query.search(file.read_text()) for file in pathlib.Path(folder).glob("out.*"))
    return {each[1]: int(each[2]) for each in found if each}


def join(printed, counts):
    """Returns the record of one run: compiler and flags, and the counts of each query."""
    context, queries = {}, []
    for line in printed.splitlines():
        if told := re.match(r"(compiler|flags|ticks): (.*)", line):
            context[told[1]] = told[2]
            continue
        name, found, tests = line.split()
        if counts.get(name, 0) < 1000:
            raise ValueError(f"{name}: {counts.get(name, 0)} instructions: nothing was counted")
        queries.append({"name": name, "instructions": counts[name], "found": int(found), "sphere_tests": int(tests)})
    return {"context": context, "queries": queries}


def count(program):
    with tempfile.TemporaryDirectory() as folder:
        return join(run(program, folder), counts_in(folder))


def compare(kept, new):
    """Returns a line per query, and the number of queries beyond the limit, with another answer, or on one side only."""
    before, after = ({query["name"]: query for query in side["queries"]} for side in (kept, new))
    lines, beyond = [], 0
    for name in before | after:
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
        for key, value in () if update else kept["context"].items():
            if new["context"][key] != value:
                raise NotComparable(f"the {key} of the counts that are kept: {value}\nthe {key} here: {new['context'][key]}")
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
