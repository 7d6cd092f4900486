#!/usr/bin/env python3
"""Counts the instructions of a sphere test and of a contact for each instruction set, by qemu, which counts alike for
x86-64 and ARM64, and writes the table to docs/performance.md. (It knows no AVX-512: of `avx3` nothing is counted.)

  scripts/target_instructions.py     builds, counts and writes; scripts/setup.sh --cross installs what it needs
"""
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/performance.md"
BEGIN, END = "<!-- instruction table -->\n", "<!-- end of instruction table -->\n"
PLUGIN = ROOT / "build/counting_plugin.so"


def run(*command):
    done = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"target_instructions: {' '.join(map(str, command))} ends with {done.returncode}:\n{(done.stdout + done.stderr)[-3000:]}")
    return done.stdout, done.stderr


def counted(preset, qemu):
    """By target and question: instructions, sphere tests and leaf pairs."""
    run("cmake", "--preset", preset, *(["-DIST_TESTS=ON"] if preset == "release" else []))
    build = ROOT / "build" / preset
    run("cmake", "--build", build, "--target", "target_instructions", "--", f"-j{os.cpu_count()}")
    out, marks = run(*qemu, "-plugin", PLUGIN, build / "tests/target_instructions")
    counts = [int(line.split()[1]) for line in marks.splitlines() if line.startswith("mark ")][1::2]
    rows = {}
    for line, instructions in zip(out.splitlines(), counts, strict=True):
        target, question, tests, pairs = line.split()
        rows.setdefault(target, {})[question] = (instructions, int(tests), int(pairs))
    return rows


def main():
    if sys.argv[1:]:
        print(__doc__.strip())
        sys.exit(0 if sys.argv[1] in ("-h", "--help") else 2)
    page = PAGE.read_text()
    before, _, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not end:
        sys.exit(f"target_instructions: {PAGE} has no place for the table: {BEGIN.strip()}")
    run("cc", "-shared", "-fPIC", "-O2", "-o", PLUGIN, ROOT / "tests/instructions/counting_plugin.c")
    lines = ["| platform | target | leaf pairs | a sphere test | contacts | more a leaf pair |\n", "|---|---|---|---|---|---|\n"]
    for platform, preset, qemu in (("x86-64", "release", ["qemu-x86_64", "-cpu", "max"]), ("ARM64", "arm64", ["qemu-aarch64"])):
        for target, asked in counted(preset, qemu).items():
            listed, tests, pairs = asked["leaf_pairs"]
            summed = asked["contacts"][0]
            lines.append(f"| {platform} | `{target}` | {listed:,} | {listed / tests:.1f} | {summed:,} | {(summed - listed) / pairs:.0f} |\n")
    PAGE.write_text(before + BEGIN + "".join(lines) + END + after)
    print("".join(lines), end="")


if __name__ == "__main__":
    main()
