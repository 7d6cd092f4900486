#!/usr/bin/env python3
"""Counts the instructions of a sphere test and of a contact for each instruction set, and writes the table to
docs/performance.md: by qemu, which counts alike for x86-64 and ARM64; those of `avx3`, which it does not know, one by one
on this machine, which needs AVX-512.

  scripts/target_instructions.py     builds, counts and writes; scripts/setup.sh --tests --cross installs what it needs
"""
import os
import subprocess
import sys
from pathlib import Path

from report.figures import here, stamp
from report.tables import fill

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/performance.md"
PLUGIN = ROOT / "build/counting_plugin.so"
STEPS = ROOT / "build/counting_steps"
QEMU = ["-plugin", PLUGIN]
# The platform, the preset, and what runs a program and counts for the targets named, or for all.
COUNTERS = [
    ("x86-64", "release", [STEPS], ["avx3"]),
    ("x86-64", "release", ["qemu-x86_64", "-cpu", "max", *QEMU], []),
    ("ARM64", "arm64", ["qemu-aarch64", *QEMU], []),
]


def run(*command):
    done = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"target_instructions: {' '.join(map(str, command))} ends with {done.returncode}:\n{(done.stdout + done.stderr)[-3000:]}")
    return done.stdout, done.stderr


def counted(preset, counter, targets):
    """By target and question: instructions, sphere tests and leaf pairs."""
    run("cmake", "--preset", preset, *(["-DIST_TESTS=ON"] if preset == "release" else []))
    build = ROOT / "build" / preset
    run("cmake", "--build", build, "--target", "target_instructions", "--", f"-j{os.cpu_count()}")
    out, marks = run(*counter, build / "tests/target_instructions", *targets)
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
    PLUGIN.parent.mkdir(exist_ok=True)
    run("cc", "-shared", "-fPIC", "-O2", "-o", PLUGIN, ROOT / "tests/instructions/counting_plugin.c")
    run("cc", "-O2", "-o", STEPS, ROOT / "tests/instructions/counting_steps.c")
    asked_of = set()  # sphere tests and leaf pairs: the same on every platform
    lines = ["| platform | target | leaf pairs | a sphere test | contacts | more a leaf pair |\n", "|---|---|---|---|---|---|\n"]
    for platform, preset, counter, targets in COUNTERS:
        rows = counted(preset, counter, targets)
        if targets and not rows:
            sys.exit(f"target_instructions: this processor has no {targets[0]}: run it on one that has")
        for target, asked in rows.items():
            listed, tests, pairs = asked["leaf_pairs"]
            summed = asked["contacts"][0]
            asked_of.add((tests, pairs))
            lines.append(f"| {platform} | `{target}` | {listed:,} | {listed / tests:.1f} | {summed:,} | {(summed - listed) / pairs:.0f} |\n")
    if len(asked_of) != 1:
        sys.exit(f"target_instructions: platforms differ in sphere tests and leaf pairs: {sorted(asked_of)}")
    lines += ["\n", "Each makes {:,} sphere tests and lists {:,} leaf pairs.\n".format(*asked_of.pop())]
    lines += ["\n", stamp(*here(), "target_instructions.py")]
    fill(PAGE, "instruction table", "".join(lines))
    print("".join(lines))


if __name__ == "__main__":
    main()
