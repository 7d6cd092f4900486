#!/usr/bin/env python3
"""Tests the tests: breaks a copy of the code in one named way after the other (scripts/mutants), and runs tests until one fails. A mutant that no
test kills fails the run. All of them take up to three hours on two cores. Writes perf/MUTANTS.md; a run of some renews their rows.

    scripts/mutate.py               every mutant
    scripts/mutate.py NAME...       those whose names contain one of these words
    scripts/mutate.py --missing     those that no test has killed at this commit, as after a run that was cut short
    scripts/mutate.py --list        their names, and what each breaks"""

import filecmp
import json
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

from machine import output, refuse, run
from mutants import MUTANTS
from report.figures import ROOT, git, stamp
from report.tables import markdown

COPY = ROOT / "build/mutants/source"
BUILD = ROOT / "build/mutants/build"
RESULTS = ROOT / "perf/results/mutants.json"
# Targets of ctest tests.
PACKAGED = {"ist_shared", "ist_loop_shared", "ist_hardware_shared", "ist_cli", "ist_pages", "package_layout", "scene_keys"}
SECONDS = 600  # for one program: a mutant that hangs is found out too


def copy_sources():
    """Copies the sources as they are now. Unchanged files keep their time, and files that are gone from the sources go from the copy."""
    there = {name for name in git("ls-files", "-z", "--cached", "--others", "--exclude-standard").split("\0") if (ROOT / name).is_file()}
    for copy in [path for path in COPY.rglob("*") if path.is_file() and str(path.relative_to(COPY)) not in there]:
        copy.unlink()
    for name in there:
        if not (COPY / name).is_file() or not filecmp.cmp(ROOT / name, COPY / name, shallow=False):
            (COPY / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, COPY / name)  # with its permissions


def edited(edits, root=COPY):
    """Returns the changed texts of a mutant's files. Each file must have its passage once."""
    texts = {}
    for file, old, new in edits:
        path = root / file
        text = texts.get(path) or path.read_text()
        if text.count(old) != 1:
            sys.exit(f"mutate: {file} has {text.count(old)} times, and should have once:\n{old}")
        texts[path] = text.replace(old, new)
    return texts


def build(programs):
    """Builds the programs. Returns None, or the compiler's output if it fails."""
    if not programs:
        return None
    done = subprocess.run(["cmake", "--build", BUILD, "--target", *programs, "--", f"-j{os.cpu_count()}"], capture_output=True, text=True)
    return None if done.returncode == 0 else done.stdout + done.stderr


def first_failure(tests):
    """Returns the name of the first test that fails, or None. Mutant.tests defines a test."""
    environment = {"IST_DATA_DIR": str(ROOT.parent / "shared/data"), "IST_REQUIRE_ALL": "1", **os.environ}
    for test in tests:
        program, _, pattern = test.partition(" ")
        command = [BUILD / "tests" / program, "--gtest_fail_fast"]
        if program == "ctest":
            command = ["ctest", "--test-dir", BUILD, "--no-tests=error", "-R", f"^{pattern}$"]
        elif program == "node":
            command = ["node", "--test", COPY / "tests/viewer" / pattern]
        elif program == "python":
            file, *cases = pattern.split()
            command = ["python3", "-B", COPY / "tests/scripts" / file, *cases]
        elif pattern:
            command.append(f"--gtest_filter={pattern}")
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, env=environment, errors="replace")
        except subprocess.TimeoutExpired:
            return f"{program} (does not end)"
        if "Running 0 tests" in done.stdout or "No tests were found" in done.stdout + done.stderr:
            sys.exit(f"mutate: no test is called {test}")
        if done.returncode != 0:
            failed = re.search(r"\[  FAILED  \] ([\w/.]+)|- ([\w.]+) \(Failed\)|^not ok \d+ - (.*)|^FAIL: (\w+)", done.stdout + done.stderr, re.M)
            return next(filter(None, failed.groups())) if failed else f"{program} (ends with {done.returncode})"
    return None


def killer_of(mutant):
    """Returns the name of the test that kills a mutant, "a proof at compile time", or None."""
    texts = edited(mutant.edits)
    before = {path: path.read_text() for path in texts}
    try:
        for path, text in texts.items():
            path.write_text(text)
        refused = build(programs_of([mutant]))
        if refused:
            if "static assertion failed" in refused:
                return "a proof at compile time"
            sys.exit(f"mutate: {mutant.name} does not compile:\n{refused[-3000:]}")
        return first_failure(mutant.tests)
    finally:
        for path, text in before.items():
            path.write_text(text)


def programs_of(mutants):
    programs = {test.split()[0] for mutant in mutants for test in mutant.tests}
    return sorted(programs - {"ctest", "node", "python"} | (PACKAGED if "ctest" in programs else set()))


def results():
    """Returns the kept results. A mutant has the test that killed it, and the commit of that run."""
    return json.loads(RESULTS.read_text()) if RESULTS.is_file() else {}


def commit():
    """Returns the commit of the sources, with a plus if files outside perf/ differ from it."""
    return git("rev-parse", "--short=7", "HEAD").strip() + ("+" if git("status", "--porcelain", "--", ":!perf").strip() else "")


def write_table(found):
    """Writes the results and perf/MUTANTS.md; mutants that never ran are marked "not run"."""
    names = {mutant.name for mutant in MUTANTS}
    known = {name: row for name, row in {**results(), **found}.items() if name in names}
    RESULTS.write_text(json.dumps(known, indent=1) + "\n")
    commits = sorted({row["commit"] for row in known.values()})
    rows = [[mutant.name, mutant.breaks, ", ".join(sorted({f"`{Path(file).name}`" for file, _, _ in mutant.edits})),
             known.get(mutant.name, {"killed_by": "not run"})["killed_by"] or "**survives**"] for mutant in MUTANTS]
    lines = ["# Mutants", "",
             "Each mutant is one deliberate fault in the code. The last column names the first test that fails with it. Made by",
             "`scripts/mutate.py` from `scripts/mutants`.", "", *markdown(["mutant", "fault", "in", "killed by"], rows), "",
             f"{sum(row[-1] not in ('not run', '**survives**') for row in rows)} of {len(MUTANTS)} killed."]
    for name in commits:
        ran = sum(row["commit"] == name for row in known.values())
        # This history lacks a commit after a rebase.
        day = (git("show", "-s", "--format=%cs", name.rstrip("+")) or "an unknown day").strip()
        lines += ["", stamp(name, day, "mutate.py", f"{ran} of them ran there.")]
    (ROOT / "perf/MUTANTS.md").write_text("\n".join(lines) + "\n")


def main():
    words = sys.argv[1:]
    refuse([word for word in words if word in ("-h", "--help")], __doc__)
    if words == ["--list"]:
        for mutant in MUTANTS:
            edited(mutant.edits, ROOT)  # it still applies
            print(f"{mutant.name:34} {mutant.breaks}")
        return
    run("scripts/setup.sh", "--tests", "--hardware", "--package")
    now, known = commit(), results()
    missing = words == ["--missing"]
    chosen = [m for m in MUTANTS if not words or any(word in m.name for word in words)
              or (missing and (known.get(m.name, {}).get("commit") != now or known[m.name]["killed_by"] is None))]
    if missing and not chosen:
        print("tests have killed every mutant at this commit")
        return
    if not chosen:
        sys.exit(f"mutate: no mutant is named like {' or '.join(words)}; --list names them")
    copy_sources()
    for mutant in chosen:
        edited(mutant.edits)  # all of them still apply, before an hour is spent
    output("cmake", "-S", COPY, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG",
           "-DIST_ASSERTS=ON", "-DIST_CLI=ON")
    programs = programs_of(chosen)
    if programs:
        print(f"building {', '.join(programs)}", flush=True)
    if refused := build(programs):
        sys.exit(f"mutate: the code as it is does not compile:\n{refused[-3000:]}")
    if broken := first_failure(sorted({test for m in chosen for test in m.tests})):
        sys.exit(f"mutate: {broken} fails with the code as it is")
    found = {}
    for number, mutant in enumerate(chosen, 1):
        start = time.monotonic()
        killer = killer_of(mutant)
        found[mutant.name] = {"killed_by": killer, "commit": now}
        write_table(found)  # for a run that is cut short
        print(f"{number:2}/{len(chosen)} {mutant.name:34} {killer or 'SURVIVES'} ({time.monotonic() - start:.0f} s)", flush=True)
    survivors = [name for name, row in found.items() if row["killed_by"] is None]
    print(f"{len(found) - len(survivors)} of {len(found)} mutants are killed")
    if survivors:
        sys.exit(f"mutate: no test notices: {', '.join(survivors)}")


if __name__ == "__main__":
    main()
