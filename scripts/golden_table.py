#!/usr/bin/env python3
"""Builds golden_test by each supported compiler, optimisation and platform, runs it for each instruction set, and
writes the table of hashes to docs/guarantees.md. Ends with 1, and writes nothing, where two hashes differ.

  scripts/golden_table.py           builds, runs and writes; 15 minutes on two cores
  scripts/golden_table.py --check   ends with 1 where the table in the page is another; names the targets that this
                                    processor lacks, which are not compared

scripts/setup.sh --tests --cross installs what it needs.
"""
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/guarantees.md"
BEGIN, END = "<!-- golden table -->\n", "<!-- end of golden table -->\n"
STRICT = "-DIST_WERROR=ON"  # where no other test compiles
GOLDEN = ["-DIST_TESTS=OFF", "-DIST_GOLDEN=ON", "-DIST_CLI=OFF", "-DIST_INSTALL=OFF", "-DIST_UNITY=ON"]


def optimised(level):
    return ["-G", "Ninja", "-DCMAKE_CXX_COMPILER=g++", "-DCMAKE_BUILD_TYPE=None", f"-DCMAKE_CXX_FLAGS={level}", *GOLDEN]


# By what the table calls it: the folder below build/, what configures it, and the words before the program.
BUILDS = {
    "x86-64, g++ -O0": ("golden-O0", optimised("-O0"), []),
    "x86-64, g++ -O2": ("golden-O2", optimised("-O2"), []),
    "x86-64, g++ -O3, asserts (preset `test`)": ("test", ["--preset", "test"], []),
    "x86-64, g++ -O3 (preset `release`)": ("release", ["--preset", "release", "-DIST_TESTS=ON"], []),
    "x86-64, clang 14 -O3": ("clang14", ["--preset", "clang14", STRICT], []),
    "x86-64, clang 16 -O3": ("clang16", ["--preset", "clang16", STRICT], []),
    "ARM64, g++ -O3, by qemu": ("arm64", ["--preset", "arm64", STRICT], ["qemu-aarch64"]),
    "WebAssembly, emscripten -O3, by node": ("wasm", ["--preset", "wasm"], ["node"]),
    "WebAssembly without SIMD128": ("wasm-scalar", ["--preset", "wasm", "-DIST_WITH_VECTORS=OFF", "-B", "build/wasm-scalar"], ["node"]),
}


def run(*command, **keywords):
    done = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True, **keywords)
    if done.returncode != 0:
        sys.exit(f"golden_table: {' '.join(map(str, command))} ends with {done.returncode}:\n{(done.stdout + done.stderr)[-3000:]}")
    return done.stdout


def hashes_of(name):
    """The hash of all golden answers, by target."""
    folder, configure, runner = BUILDS[name]
    build = ROOT / "build" / folder
    place = [] if "--preset" in configure else ["-S", ROOT, "-B", build]
    run("cmake", "--fresh", *place, *configure)
    run("cmake", "--build", build, "--target", "golden_test", "--", f"-j{os.cpu_count()}")
    program = build / ("tests/golden_test.js" if runner == ["node"] else "tests/golden_test")
    rows = [line.split("\t") for line in run(*runner, program, "--hashes").splitlines()]
    return {target: value for target, answers, value in rows if answers == "all"}


ROW = re.compile(r"\| (.+?) \| (.+?) \| (.+?) \|\n")


def line_of(name, hashes):
    """A row of the table."""
    return f"| {name} | {', '.join(f'`{target}`' for target in hashes)} | {', '.join(f'`{value}`' for value in dict.fromkeys(hashes.values()))} |\n"


def rows_of(text):
    """The targets and the hashes of a table, by build."""
    words = re.compile("`([^`]*)`")
    return {name: (words.findall(targets), words.findall(hashes)) for name, targets, hashes in ROW.findall(text)[1:] if "`" in hashes}


def made_here():
    """The hashes by build and target. Ends the program where two differ."""
    made, seen = {}, {}
    for name in BUILDS:
        print(name, flush=True)
        made[name] = hashes_of(name)
        for target, value in made[name].items():
            seen.setdefault(value, []).append(f"{name}, {target}")
    if len(seen) != 1:
        sys.exit("golden_table: the answers differ:\n" + "\n".join(f"{value}: {'; '.join(where)}" for value, where in seen.items()))
    return made


def compared(shown, made):
    """The ways in which a page's table differs from what was made here, and the builds with the targets that this processor lacks."""
    wrong, absent = [], {}
    for name in {**shown, **made}:
        if name not in shown or name not in made:
            wrong.append(f"{name} is in {'the page' if name in shown else 'this run'} alone")
            continue
        targets, hashes = shown[name]
        if set(hashes) != set(made[name].values()):
            wrong.append(f"{name}: the page shows {', '.join(hashes)}, and here it is {', '.join(set(made[name].values()))}")
        if new := [target for target in made[name] if target not in targets]:
            wrong.append(f"{name}: the page lacks {', '.join(new)}")
        if missing := [target for target in targets if target not in made[name]]:
            absent[name] = missing
    return wrong, absent


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        print(__doc__.strip())
        sys.exit(0 if sys.argv[1:] in (["-h"], ["--help"]) else 2)
    page = PAGE.read_text()
    before, _, rest = page.partition(BEGIN)
    shown, end, after = rest.partition(END)
    if not end:
        sys.exit(f"golden_table: {PAGE} has no place for the table: {BEGIN.strip()}")
    made = made_here()
    wrong, absent = compared(rows_of(shown), made)
    for name, targets in absent.items():
        print(f"{name}: this processor has no {', '.join(targets)}: not compared")
    if check:
        sys.exit("golden_table: " + "; ".join(wrong) + ": run scripts/golden_table.py" if wrong else 0)
    if absent:
        sys.exit("golden_table: the page keeps its table, which has more targets: run this where all of them are")
    lines = "".join(line_of(name, hashes) for name, hashes in made.items())
    PAGE.write_text(before + BEGIN + "| build | targets | hash of all golden answers |\n|---|---|---|\n" + lines + END + after)


if __name__ == "__main__":
    main()
