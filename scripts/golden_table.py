#!/usr/bin/env python3
"""Builds golden_test by each supported compiler, optimisation and platform, runs it for each instruction set, and
writes the table of hashes to docs/guarantees.md. If two hashes differ, it writes nothing and ends with 1.

  scripts/golden_table.py           builds, runs and writes; 15 minutes on two cores
  scripts/golden_table.py --check   ends with 1 if the page has another table. It names the targets that this processor lacks, and
                                    does not compare them

scripts/setup.sh --tests --cross installs the compilers.
"""
import os
import re
import sys

from machine import output, refuse
from report.figures import ROOT
from report.tables import BLOCK, fill, markdown

PAGE = ROOT / "docs/guarantees.md"
BLOCK_NAME = "golden table"
STRICT = "-DIST_WERROR=ON"  # for builds that no other test compiles
GOLDEN = ["-DIST_TESTS=OFF", "-DIST_GOLDEN=ON", "-DIST_CLI=OFF", "-DIST_INSTALL=OFF", "-DIST_UNITY=ON"]


def optimised(level):
    return ["-G", "Ninja", "-DCMAKE_CXX_COMPILER=g++", "-DCMAKE_BUILD_TYPE=None", f"-DCMAKE_CXX_FLAGS={level}", *GOLDEN]


# Keys are the names in the table. Values are the folder below build/, the options that configure it, and the words before the program.
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


def hashes_of(name):
    """Returns the hash of all golden answers, by target."""
    folder, configure, runner = BUILDS[name]
    build = ROOT / "build" / folder
    place = [] if "--preset" in configure else ["-S", ROOT, "-B", build]
    output("cmake", "--fresh", *place, *configure)
    output("cmake", "--build", build, "--target", "golden_test", "--", f"-j{os.cpu_count()}")
    program = build / ("tests/golden_test.js" if runner == ["node"] else "tests/golden_test")
    rows = [line.split("\t") for line in output(*runner, program, "--hashes").stdout.splitlines()]
    return {target: value for target, answers, value in rows if answers == "all"}


ROW = re.compile(r"\| (.+?) \| (`.+?`) \| (`.+?`) \|\n")


def rows_of(text):
    """Returns the targets and the hashes of a table, by build."""
    return {name: (re.findall("`([^`]*)`", targets), re.findall("`([^`]*)`", hashes)) for name, targets, hashes in ROW.findall(text)}


def made_here():
    """Returns the hashes by build and target. Ends the program if two differ."""
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
    """Returns how a page's table differs from the hashes that were made here, and the builds with the targets that this processor lacks."""
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
    refuse([] if check else sys.argv[1:], __doc__)
    made = made_here()
    shown = next((block[0] for block in BLOCK.finditer(PAGE.read_text()) if block[2] == BLOCK_NAME), "")
    wrong, absent = compared(rows_of(shown), made)
    for name, targets in absent.items():
        print(f"{name}: this processor has no {', '.join(targets)}: not compared")
    if check:
        sys.exit("golden_table: " + "; ".join(wrong) + ": run scripts/golden_table.py" if wrong else 0)
    if absent:
        sys.exit("golden_table: the page keeps its table, which has more targets: run this on a processor that has all of them")
    rows = [[name, *(", ".join(f"`{word}`" for word in dict.fromkeys(words)) for words in (hashes, hashes.values()))]
            for name, hashes in made.items()]
    fill(PAGE, BLOCK_NAME, "\n".join(markdown(["build", "targets", "hash of all golden answers"], rows)))


if __name__ == "__main__":
    main()
