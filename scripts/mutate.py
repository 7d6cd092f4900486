#!/usr/bin/env python3
"""Tests the tests: breaks the code in one named way after the other (scripts/mutants), in a copy, and runs tests until one fails.
A mutant that no test kills fails the run. All of them take up to three hours on two cores. Writes perf/MUTANTS.md; a run of some
renews their rows.

    scripts/mutate.py               every mutant
    scripts/mutate.py NAME...       those whose names contain one of these words
    scripts/mutate.py --missing     those that no test has killed at this commit, as after a run that was cut short
    scripts/mutate.py --list        their names, and what each breaks"""

import json
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

from mutants import MUTANTS
from report.figures import stamp

ROOT = Path(__file__).resolve().parent.parent
COPY = ROOT / "build/mutants/source"
BUILD = ROOT / "build/mutants/build"
RESULTS = ROOT / "perf/results/mutants.json"
# Targets of ctest tests.
PACKAGED = {"ist_shared", "ist_loop_shared", "ist_hardware_shared", "ist_cli", "ist_pages", "package_layout", "scene_keys"}
SECONDS = 600  # for one program: a mutant that hangs is found out too


def fail(text):
    print(f"mutate: {text}", file=sys.stderr)
    sys.exit(1)


def sources():
    for folder in ["src", "simd", "tests", "bench", "examples", "scripts", "docs", "perf"]:
        yield from (path for path in (ROOT / folder).rglob("*") if path.is_file())
    for name in ["CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "HACKING.md", "CONTRIBUTING.md", "CHANGELOG.md"]:
        yield ROOT / name


def copy_sources():
    """Copies the sources as they are now; unchanged files keep their time, and files that are gone go."""
    there = {source.relative_to(ROOT) for source in sources()}
    for copy in [path for path in COPY.rglob("*") if path.is_file()]:
        if copy.relative_to(COPY) not in there:
            copy.unlink()
    for source in sources():
        copy = COPY / source.relative_to(ROOT)
        if copy.is_file() and copy.read_bytes() == source.read_bytes():
            continue
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, copy)  # scripts stay such


def edited(edits, root=COPY):
    """The texts that a mutant's files get. Each passage must be there once, and once only."""
    texts = {}
    for file, old, new in edits:
        path = root / file
        text = texts.get(path) or path.read_text()
        if text.count(old) != 1:
            fail(f"{file} has {text.count(old)} times, and should have once:\n{old}")
        texts[path] = text.replace(old, new)
    return texts


def configure():
    subprocess.run(
        ["cmake", "-S", COPY, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
         "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG", "-DIST_ASSERTS=ON", "-DIST_CLI=ON"],
        check=True, stdout=subprocess.DEVNULL)


def build(programs):
    """Builds the programs. Returns None, or the compiler's output if it fails."""
    if not programs:
        return None
    done = subprocess.run(["cmake", "--build", BUILD, "--target", *programs, "--", f"-j{os.cpu_count()}"],
                          capture_output=True, text=True)
    return None if done.returncode == 0 else done.stdout + done.stderr


def first_failure(tests):
    """The first test that fails, or None; a mutant's `tests` say what a test is."""
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
            done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS,
                                  env=environment, errors="replace")
        except subprocess.TimeoutExpired:
            return f"{program} (does not end)"
        if "Running 0 tests" in done.stdout or "No tests were found" in done.stdout + done.stderr:
            fail(f"no test is called {test}")
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
            fail(f"{mutant.name} does not compile:\n{refused[-3000:]}")
        return first_failure(mutant.tests)
    finally:
        for path, text in before.items():
            path.write_text(text)


def programs_of(mutants):
    programs = {test.split()[0] for mutant in mutants for test in mutant.tests}
    return sorted(programs - {"ctest", "node", "python"} | (PACKAGED if "ctest" in programs else set()))


def results():
    """What is known: by mutant, the test that killed it, and the commit at which it did."""
    return json.loads(RESULTS.read_text()) if RESULTS.is_file() else {}


def commit():
    """The commit of the sources, with a plus where they differ from it but for what this script writes."""
    git = ["git", "-C", ROOT]
    head = subprocess.run([*git, "rev-parse", "--short=7", "HEAD"], capture_output=True, text=True, check=True).stdout.strip()
    changed = subprocess.run([*git, "status", "--porcelain", "--", ":!perf"], capture_output=True, text=True, check=True).stdout
    return head + ("+" if changed.strip() else "")


def date_of(name):
    """The day of a commit; of one that this history does not have, as after a rebase, no day is known."""
    shown = subprocess.run(["git", "-C", ROOT, "show", "-s", "--format=%cs", name.rstrip("+")], capture_output=True, text=True,
                           check=False)
    return shown.stdout.strip() if shown.returncode == 0 else "an unknown day"


def write_table(found):
    """Writes the results and perf/MUTANTS.md; mutants that never ran are marked "not run"."""
    names = {mutant.name for mutant in MUTANTS}
    known = {name: row for name, row in {**results(), **found}.items() if name in names}
    RESULTS.write_text(json.dumps(known, indent=1) + "\n")
    commits = sorted({row["commit"] for row in known.values()})
    lines = ["# Mutants", "",
             "Each mutant is one deliberate fault in the code. The last column names the first test that fails with it. Made by",
             "`scripts/mutate.py` from `scripts/mutants`.", "",
             "| mutant | fault | in | killed by |", "|---|---|---|---|"]
    killed = 0
    for mutant in MUTANTS:
        killer = known.get(mutant.name, {"killed_by": "not run"})["killed_by"]
        killed += killer not in (None, "not run")
        files = ", ".join(sorted({f"`{Path(file).name}`" for file, _, _ in mutant.edits}))
        lines.append(f"| {mutant.name} | {mutant.breaks} | {files} | {killer or '**survives**'} |")
    lines += ["", f"{killed} of {len(MUTANTS)} killed."]
    for name in commits:
        ran = sum(row["commit"] == name for row in known.values())
        lines += ["", stamp(name, date_of(name), "mutate.py", f"{ran} of them ran there.")]
    (ROOT / "perf/MUTANTS.md").write_text("\n".join(lines) + "\n")


def main():
    words = sys.argv[1:]
    if words[:1] in (["-h"], ["--help"]):
        print(__doc__)
        return
    if words == ["--list"]:
        for mutant in MUTANTS:
            edited(mutant.edits, ROOT)  # it still applies
            print(f"{mutant.name:34} {mutant.breaks}")
        return
    subprocess.run([ROOT / "scripts/setup.sh", "--tests", "--hardware", "--package"], check=True)
    now, known = commit(), results()
    missing = words == ["--missing"]
    chosen = [m for m in MUTANTS if not words or any(word in m.name for word in words)
              or (missing and (known.get(m.name, {}).get("commit") != now or known[m.name]["killed_by"] is None))]
    if missing and not chosen:
        print("tests have killed every mutant at this commit")
        return
    if not chosen:
        fail(f"no mutant is named like {' or '.join(words)}; --list names them")
    copy_sources()
    for mutant in chosen:
        edited(mutant.edits)  # all of them still apply, before an hour is spent
    configure()
    programs = programs_of(chosen)
    if programs:
        print(f"building {', '.join(programs)}", flush=True)
    if refused := build(programs):
        fail(f"the code as it is does not compile:\n{refused[-3000:]}")
    if broken := first_failure(sorted({test for m in chosen for test in m.tests})):
        fail(f"{broken} fails with the code as it is")
    found = {}
    for number, mutant in enumerate(chosen, 1):
        start = time.monotonic()
        killer = killer_of(mutant)
        found[mutant.name] = {"killed_by": killer, "commit": now}
        write_table(found)  # for a run that is cut short
        print(f"{number:2}/{len(chosen)} {mutant.name:34} {killer or 'SURVIVES'} "
              f"({time.monotonic() - start:.0f} s)", flush=True)
    survivors = [name for name, row in found.items() if row["killed_by"] is None]
    print(f"{len(found) - len(survivors)} of {len(found)} mutants are killed")
    if survivors:
        fail(f"no test notices: {', '.join(survivors)}")


if __name__ == "__main__":
    main()
