#!/usr/bin/env python3
"""Writes what the long runs gave to docs/guarantees.md, from the logs of scripts/long.sh in build/long. Rows of parts that
have no log here are kept. Ends with 1, and writes nothing, where no part has a log that was ended.

  scripts/long_table.py
"""
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/guarantees.md"
BEGIN, END = "<!-- long runs -->\n", "<!-- end of long runs -->\n"
VERDICT = re.compile(r"(passed|skipped|failed) at (\w+)( with changes)? on ([\d-]+) in (\d+) s\n?\Z")

# What a part tries, by its name; several rounds of one kind are one row.
PARTS = {
    "suite": "`scripts/test.sh`",
    "as-users-build": "tests of the library as users build it: file by file, without assertions",
    "packages": "tests of packages, wheels, the page in a browser, the circuit's synthesis",
    "benches": "all benchmarks compile without a warning",
    "golden": "golden answers by every compiler, optimisation and platform",
    "arm64": "a program built for ARM64 from the package",
    "portable": "golden answers of the portable library",
    "sanitize-all": "every room and test under AddressSanitizer and UndefinedBehaviorSanitizer",
    "compile-all": "the library compiled inside a user's build, and from the sdist",
    "cloudcompare": "distances of two pairs of jaws against CloudCompare's",
    "blender": "the add-on in Blender",
    "threads": "eight threads ask one tree, under ThreadSanitizer",
    "stability": "perf/STABILITY.md: hard cases with 20 times the samples, ten million queries of real jaws",
    "kills": "a sweep killed at any moment",
    "pressing": "simulated presses of the human jaws, voxels of 0.8 and of 0.2 mm",
    "coherent": "coherent queries against fresh ones",
    "five-bodies": "presses among five bodies",
    "doors": "four ways in (tests/doors)",
    "release": "the release folder, made twice with the same bytes",
    "fuzz": "fuzzers, each 5 minutes a round",
}


def seen_in(log, cases):
    """What a part's log and its stability cases count, by what it counts."""
    found = {}

    def add(what, counts):
        if counts:
            found[what] = sum(int(count) for count in counts)

    for way in ("in a bare Debian 12 root", "in unpacked packages"):
        add(way, re.findall(rf"^door \w+, {way}", log, re.M) and [1])

    add("tests", re.findall(r"tests passed, 0 tests failed out of (\d+)", log) + re.findall(r"^\[  PASSED  \] (\d+) tests?", log, re.M))
    add("ticks", re.findall(r"^(\d+) ticks: ", log, re.M))
    add("executions", re.findall(r": (\d+) executions in ", log))
    lines = [json.loads(line) for line in cases.splitlines()]
    if lines:
        found["most samples of a case"] = max(line["samples"] for line in lines)
        found["cases"] = len(lines)
        found["broken"] = sum(line["broken"] for line in lines)
    return found


def results(folder):
    """The parts that ended, as (kind, verdict, commit, date, seconds, counts), in the order of PARTS."""
    made = []
    for log in folder.glob("*.log"):
        text = log.read_text(errors="replace")
        verdict = VERDICT.search(text)
        kind = max((name for name in PARTS if log.stem == name or log.stem.startswith(name + "-")), key=len, default=None)
        if verdict is None or kind is None:
            continue
        cases = log.with_suffix(".jsonl")
        state, commit, changes, date, seconds = verdict.groups()
        made.append((kind, state, commit + ("+" if changes else ""), date, int(seconds), seen_in(text, cases.read_text() if cases.exists() else "")))
    return sorted(made, key=lambda part: (list(PARTS).index(part[0]), part[3]))


def kept_rows(table, parts):
    """The rows of a table whose kinds are not among these parts, by kind."""
    kinds, found = {title: kind for kind, title in PARTS.items()}, {}
    for row in table.splitlines(keepends=True):
        kind = kinds.get(row.split(" | ")[0].removeprefix("| "))
        if kind and kind not in {part[0] for part in parts}:
            found.setdefault(kind, []).append(row)
    return found


def rows(parts):
    """A row for each kind, and for each verdict and commit of it, by kind."""
    groups, made = {}, {}
    for kind, state, commit, date, seconds, counts in parts:
        group = groups.setdefault((kind, state, commit), [0, 0, date, {}])
        group[0] += 1
        group[1] += seconds
        group[2] = date
        for what, count in counts.items():
            group[3][what] = group[3].get(what, 0) + count
    for (kind, state, commit), (number, seconds, date, counts) in groups.items():
        verdict = state if state == "passed" else f"**{state}**"
        time = f"{seconds / 60:,.0f} min" if seconds >= 60 else f"{seconds} s"
        counted = ", ".join(f"{what}: {count:,}" for what, count in counts.items()) or "–"
        made.setdefault(kind, []).append(
            f"| {PARTS[kind]} | {verdict}{f' {number} times' if number > 1 else ''} | {counted} | `{commit}`, {date} | {time} |\n")
    return made


def written(text, parts):
    """The page with the table of these parts, and of those that it had."""
    before, begin, rest = text.partition(BEGIN)
    table, end, after = rest.partition(END)
    if not begin or not end:
        sys.exit(f"long_table: the page has no place for the table: {BEGIN.strip()}")
    head = "| part | ended | counted | commit | time |\n|---|---|---|---|---|\n"
    all_rows = kept_rows(table, parts) | rows(parts)
    return before + BEGIN + head + "".join(row for kind in PARTS for row in all_rows.get(kind, [])) + END + after


def main():
    if len(sys.argv) > 1:
        print(__doc__.strip())
        sys.exit(0 if sys.argv[1:] in (["-h"], ["--help"]) else 2)
    parts = results(ROOT / "build/long")
    if not parts:
        sys.exit("long_table: no part has ended: run scripts/long.sh")
    PAGE.write_text(written(PAGE.read_text(), parts))


if __name__ == "__main__":
    main()
