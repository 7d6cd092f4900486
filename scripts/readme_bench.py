#!/usr/bin/env python3
"""Writes the figures of the README: what `ist bench` prints on this machine.

    scripts/readme_bench.py     on a quiet machine, after cmake --preset release && cmake --build --preset release, and
                                cmake --preset bench && cmake --build --preset bench --target fixed_loop
"""
import os
import re
import sys

from machine import machine, output, refuse
from report.figures import ROOT, here, machine_state, stamp
from report.runner import fixed_loop
from report.tables import fill

PROGRAM = ROOT / "build/release/ist"
MOST_LOAD = 0.5  # cores that other work may take


def main():
    refuse(sys.argv[1:], __doc__)
    os.chdir(ROOT)
    commit, date = here()
    if commit.endswith("+"):
        sys.exit("readme_bench: the code differs from its commit: commit it first, so that the figures name what they are of")
    built = re.search(r"commit (\S+)", output(PROGRAM, "--version").stdout)[1]
    if not built.startswith(commit) or built.endswith("+"):
        sys.exit(f"readme_bench: {PROGRAM} was built at {built}, and this is {commit}: cmake --build --preset release")
    context = {"processor": machine().model, "load_avg": os.getloadavg(), "loop_before": fixed_loop()}
    if context["load_avg"][0] > MOST_LOAD:
        sys.exit(f"readme_bench: other work took {context['load_avg'][0]:.1f} cores: wait until nothing else runs")
    printed = output(PROGRAM, "bench").stdout
    context |= {"load_after": os.getloadavg()[0], "loop_after": fixed_loop()}
    note = "<!-- snippet: output varies, since it is times -->\n"
    text = (f"{note}```sh\nist bench\n```\n\n{note}```\n{printed}```\n\n{stamp(commit, date, 'ist bench', machine_state(context))}")
    fill(ROOT / "README.md", "ist bench", text)
    print("README.md", file=sys.stderr)


if __name__ == "__main__":
    main()
