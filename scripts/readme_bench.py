#!/usr/bin/env python3
"""Writes the figures of the README: the ratios that `ist bench` prints on this machine.

    scripts/readme_bench.py     after cmake --preset release && cmake --build --preset release; on a quiet machine
"""
import os
import re
import subprocess
import sys

from report.figures import ROOT, here, stamp
from report.tables import fill

PROGRAM = ROOT / "build/release/ist"


def ratios(printed):
    """Returns what `ist bench` prints before the times of each query, and refuses a busy machine. One that changes its speed by
    itself is named in what is printed; ratios hold there."""
    noise = re.search(r"^not a quiet machine: other work .*", printed, re.M)
    if noise:
        sys.exit(f"readme_bench: {noise.group(0)}: wait until nothing else runs")
    before, found, _ = printed.partition("\nµs a query")
    if not found:
        sys.exit(f"readme_bench: {PROGRAM} bench prints no times")
    return before.rstrip() + "\n"


def state(printed, load_after):
    """Returns a sentence on the machine before and after: what `ist bench` prints of it, and the load now."""
    found = re.search(r"load before ([\d.]+)[^;]*; a fixed loop took (\S+ to \S+ µs)", printed)
    if not found:
        sys.exit(f"readme_bench: {PROGRAM} bench prints neither the load before nor the time of its fixed loop")
    return f"Load {found.group(1)} before, {load_after:.1f} after; a fixed loop took {found.group(2)} between the queries."


def main():
    commit, date = here()
    if commit.endswith("+"):
        sys.exit("readme_bench: the code differs from its commit: commit it first, so that the figures name what they are of")
    said = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout
    built = re.search(r"commit (\S+)", said).group(1)
    if not built.startswith(commit) or built.endswith("+"):
        sys.exit(f"readme_bench: {PROGRAM} was built at {built}, and this is {commit}: cmake --build --preset release")
    done = subprocess.run([PROGRAM, "bench"], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"readme_bench: ist bench: {done.stderr}")
    note = "<!-- snippet: output varies, since it is times -->\n"
    text = (f"{note}```sh\nist bench\n```\n\n{note}```\n{ratios(done.stdout)}```\n\n"
            f"{stamp(commit, date, 'ist bench', state(done.stdout, os.getloadavg()[0]))}")
    fill(ROOT / "README.md", "ist bench", text)
    print("README.md", file=sys.stderr)


if __name__ == "__main__":
    if sys.argv[1:]:
        print(__doc__.strip())
        sys.exit(0 if sys.argv[1] in ("-h", "--help") else 2)
    main()
