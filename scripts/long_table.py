#!/usr/bin/env python3
"""Writes what the long runs gave to docs/guarantees.md, from the logs of scripts/long.sh in build/long. Rows of parts that
have no log here are kept.

  scripts/long_table.py           writes the table; ends with 1, and writes nothing, where no part has a log that was ended
  scripts/long_table.py --check   ends with 1 where a part has no row that counts: passed, and at a commit since which no code
                                  has changed. The release is made last, and may lack its row
"""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/guarantees.md"
BEGIN, END = "<!-- long runs -->\n", "<!-- end of long runs -->\n"
VERDICT = re.compile(r"(passed|skipped|failed) at (\w+)( with changes)? on ([\d-]+) in (\d+) s\n?\Z")

# What a part tries, by its name.
PARTS = {
    "suite": "`scripts/test.sh` and `scripts/test.sh --all`",
    "samples": "every test program with 20 times the random samples",
    "as-users-build": "tests of the library as users build it: file by file, without assertions",
    "packages": "tests of packages, wheels, the page in a browser, the circuit's synthesis",
    "benches": "all benchmarks compile without a warning",
    "clang-tidy": "the library and the command pass clang-tidy",
    "golden": "golden answers by every compiler, optimisation and platform",
    "arm64": "a program built for ARM64 from the package",
    "portable": "golden answers of the portable library",
    "sanitize-all": "every room and test under AddressSanitizer and UndefinedBehaviorSanitizer",
    "compile-all": "the library compiled inside a user's build, and from the sdist",
    "cloudcompare-built-in": "distances of the built-in jaws against CloudCompare's",
    "cloudcompare-human": "distances of the human jaws against CloudCompare's",
    "blender": "the add-on in Blender",
    "threads": "eight threads ask one tree, under ThreadSanitizer",
    "stability": "perf/STABILITY.md: hard cases with 20 times the samples, ten million queries of real jaws",
    "kills": "a sweep killed at any moment",
    "pressing": "simulated presses of the human jaws, voxels of 0.8 and of 0.2 mm",
    "coherent": "coherent queries against fresh ones",
    "five-bodies": "presses among five bodies",
    "release": "the release folder, made twice with the same bytes",
    "mutants": "tests notice every deliberate fault",
    "doors-scans": "a door: I have scans",
    "doors-haptics": "a door: I build a haptic loop",
    "doors-script": "a door: I script",
    "doors-cycles": "a door: I count cycles",
    **{f"fuzz-{number}": f"each fuzzer for 5 minutes, the {place} time" for number, place in
       enumerate(("first", "second", "third", "fourth", "fifth", "sixth"), 1)},
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
    add("skipped", [1 for _ in re.findall(r"^\s+\d+ - \S.* \(Skipped\)$", log, re.M)])
    add("ticks", re.findall(r"^(\d+) ticks: ", log, re.M))
    add("executions", re.findall(r": (\d+) executions in ", log))
    lines = [json.loads(line) for line in cases.splitlines()]
    if lines:
        found["most samples of a case"] = max(line["samples"] for line in lines)
        found["cases"] = len(lines)
        found["broken"] = sum(line["broken"] for line in lines)
    return found


def rows(folder):
    """The rows of the parts that ended, by part."""
    made = {}
    for part, title in PARTS.items():
        log, cases = folder / f"{part}.log", folder / f"{part}.jsonl"
        text = log.read_text(errors="replace") if log.exists() else ""
        if ended := VERDICT.search(text):
            state, commit, changes, date, seconds = ended.groups()
            verdict = state if state == "passed" else f"**{state}**"
            counts = seen_in(text, cases.read_text() if cases.exists() else "")
            counted = ", ".join(f"{what}: {count:,}" for what, count in counts.items()) or "–"
            time = f"{int(seconds) / 60:,.0f} min" if int(seconds) >= 60 else f"{seconds} s"
            made[part] = f"| {title} | {verdict} | {counted} | `{commit}{'+' if changes else ''}`, {date} | {time} |\n"
    return made


def apart(text):
    """A page before its table, the rows of the table by part, and the page after it."""
    before, begin, rest = text.partition(BEGIN)
    table, end, after = rest.partition(END)
    if not begin or not end:
        sys.exit(f"long_table: the page has no place for the table: {BEGIN.strip()}")
    parts, found = {title: part for part, title in PARTS.items()}, {}
    for row in table.splitlines(keepends=True)[2:]:
        title = row.split(" | ")[0].removeprefix("| ")
        if title not in parts:
            sys.exit(f"long_table: {PAGE.name} has a row of no part: {title}: name it as PARTS does, or remove it")
        found[parts[title]] = row
    return before, found, after


def written(text, made):
    """The page with these rows, and with those of other parts that it had."""
    before, kept, after = apart(text)
    head = "| part | ended | counted | commit | time |\n|---|---|---|---|---|\n"
    all_rows = kept | made
    return before + BEGIN + head + "".join(all_rows[part] for part in PARTS if part in all_rows) + END + after


def counts(row, part):
    """Whether a row says that the part passed, with the code as it is now; a door also with the pages that it types."""
    found = re.match(r"\| [^|]+ \| passed \| [^|]+ \| `(\w+)`, ", row)
    command = f'source scripts/parts.sh; same_code "$1" {"$pages" if part.startswith("doors-") else ""}'
    return found is not None and subprocess.run(["bash", "-c", command, "bash", found[1]], cwd=ROOT, check=False).returncode == 0


def main(words):
    if words == ["--check"]:
        _, had, _ = apart(PAGE.read_text())
        lacking = [part for part in PARTS if part != "release" and not (part in had and counts(had[part], part))]
        print(f"long_table: not passed with the code as it is: {', '.join(lacking)}: scripts/long.sh --resume runs "
              "them, and scripts/long_table.py then writes the table" if lacking else
              "every long part has passed with the code as it is")
        return 1 if lacking else 0
    if words:
        print(__doc__.strip())
        return 0 if words in (["-h"], ["--help"]) else 2
    made = rows(ROOT / "build/long")
    if not made:
        sys.exit("long_table: no part has ended: run scripts/long.sh")
    PAGE.write_text(written(PAGE.read_text(), made))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
