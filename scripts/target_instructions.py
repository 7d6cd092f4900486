#!/usr/bin/env python3
"""Counts the instructions of a sphere test and of a contact for each instruction set, and writes the table to docs/performance.md. qemu counts them,
the same way for x86-64 and ARM64. qemu does not know `avx3`: this machine counts its instructions one by one, and needs AVX-512.

  scripts/target_instructions.py     builds, counts and writes; scripts/setup.sh --tests --cross installs the tools
"""
import os
import sys

from machine import output, refuse
from report.figures import ROOT, here, stamp
from report.tables import fill, markdown

PAGE = ROOT / "docs/performance.md"
PLUGIN = ROOT / "build/counting_plugin.so"
STEPS = ROOT / "build/counting_steps"
QEMU = ["-plugin", PLUGIN]
# The platform, the preset, the command that runs a program and counts, and its targets, or none for all.
COUNTERS = [
    ("x86-64", "release", [STEPS], ["avx3"]),
    ("x86-64", "release", ["qemu-x86_64", "-cpu", "max", *QEMU], []),
    ("ARM64", "arm64", ["qemu-aarch64", *QEMU], []),
]


def counted(preset, counter, targets):
    """Returns the instructions, sphere tests and leaf pairs, by target and question."""
    output("cmake", "--preset", preset, *(["-DIST_TESTS=ON"] if preset == "release" else []))
    build = ROOT / "build" / preset
    output("cmake", "--build", build, "--target", "target_instructions", "--", f"-j{os.cpu_count()}")
    ran = output(*counter, build / "tests/target_instructions", *targets)
    counts = [int(line.split()[1]) for line in ran.stderr.splitlines() if line.startswith("mark ")][1::2]
    rows = {}
    for line, instructions in zip(ran.stdout.splitlines(), counts, strict=True):
        target, question, tests, pairs = line.split()
        rows.setdefault(target, {})[question] = (instructions, int(tests), int(pairs))
    return rows


def main():
    refuse(sys.argv[1:], __doc__)
    PLUGIN.parent.mkdir(exist_ok=True)
    output("cc", "-shared", "-fPIC", "-O2", "-o", PLUGIN, ROOT / "tests/instructions/counting_plugin.c")
    output("cc", "-O2", "-o", STEPS, ROOT / "tests/instructions/counting_steps.c")
    asked_of = set()  # sphere tests and leaf pairs: the same on every platform
    table = []
    for platform, preset, counter, targets in COUNTERS:
        rows = counted(preset, counter, targets)
        if targets and not rows:
            sys.exit(f"target_instructions: this processor has no {targets[0]}: run it on one that has")
        for target, asked in rows.items():
            listed, tests, pairs = asked["leaf_pairs"]
            summed = asked["contacts"][0]
            asked_of.add((tests, pairs))
            table.append([platform, f"`{target}`", f"{listed:,}", f"{listed / tests:.1f}", f"{summed:,}", f"{(summed - listed) / pairs:.0f}"])
    if len(asked_of) != 1:
        sys.exit(f"target_instructions: platforms differ in sphere tests and leaf pairs: {sorted(asked_of)}")
    text = "\n".join([*markdown(["platform", "target", "leaf pairs", "a sphere test", "contacts", "more a leaf pair"], table), "",
                      "Each makes {:,} sphere tests and lists {:,} leaf pairs.".format(*asked_of.pop()), "",
                      stamp(*here(), "target_instructions.py")])
    fill(PAGE, "instruction table", text)
    print(text)


if __name__ == "__main__":
    main()
