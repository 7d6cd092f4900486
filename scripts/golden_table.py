#!/usr/bin/env python3
"""Builds golden_test by each supported compiler, optimisation and platform, runs it for each instruction set, and
writes the table of hashes to docs/guarantees.md. Ends with 1, and writes nothing, where two hashes differ.

  scripts/golden_table.py           builds, runs and writes; 15 minutes on two cores
  scripts/golden_table.py --check   ends with 1 where the table in the page is another

scripts/setup.sh --cross installs what it needs.
"""
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/guarantees.md"
BEGIN, END = "<!-- golden table -->\n", "<!-- end of golden table -->\n"
GOLDEN = ["-DIST_TESTS=OFF", "-DIST_GOLDEN=ON", "-DIST_CLI=OFF", "-DIST_INSTALL=OFF", "-DIST_UNITY=ON"]


def optimised(level):
    return ["-G", "Ninja", "-DCMAKE_CXX_COMPILER=g++", "-DCMAKE_BUILD_TYPE=None", f"-DCMAKE_CXX_FLAGS={level}", *GOLDEN]


# By what the table calls it: the folder below build/, what configures it, and the words before the program.
BUILDS = {
    "x86-64, g++ -O0": ("golden-O0", optimised("-O0"), []),
    "x86-64, g++ -O2": ("golden-O2", optimised("-O2"), []),
    "x86-64, g++ -O3, asserts (preset `test`)": ("test", ["--preset", "test"], []),
    "x86-64, g++ -O3 (preset `release`)": ("release", ["--preset", "release", "-DIST_TESTS=ON"], []),
    "x86-64, clang 14 -O3": ("clang14", ["--preset", "clang14"], []),
    "x86-64, clang 16 -O3": ("clang16", ["--preset", "clang16"], []),
    "ARM64, g++ -O3, by qemu": ("arm64", ["--preset", "arm64"], ["qemu-aarch64"]),
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


def table():
    lines, seen = ["| build | targets | hash of all golden answers |\n", "|---|---|---|\n"], {}
    for name in BUILDS:
        print(name, flush=True)
        hashes = hashes_of(name)
        for target, value in hashes.items():
            seen.setdefault(value, []).append(f"{name}, {target}")
        lines.append(f"| {name} | {', '.join(f'`{target}`' for target in hashes)} | {', '.join(f'`{value}`' for value in set(hashes.values()))} |\n")
    if len(seen) != 1:
        sys.exit("golden_table: the answers differ:\n" + "\n".join(f"{value}: {'; '.join(where)}" for value, where in seen.items()))
    return "".join(lines)


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
    made = table()
    if check:
        if made != shown:
            sys.exit("golden_table: the page shows another table: run scripts/golden_table.py")
        return
    PAGE.write_text(before + BEGIN + made + END + after)


if __name__ == "__main__":
    main()
