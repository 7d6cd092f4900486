#!/usr/bin/python3
"""Runs the benchmarks and keeps their raw results in perf/results/<machine>/, one JSON file a program.

    scripts/bench.py                    all programs; installs other libraries for peers_bench
    scripts/bench.py build_bench …      some; further arguments after -- go to each program
    scripts/bench.py peers_bench        beside other libraries, which it installs too"""

import os
import sys

from machine import build, machine, refuse
from report.runner import PROGRAMS, Runner


def main(words):
    if words and words[0].startswith("-") and words[0] != "--":
        refuse(words, __doc__)
    at = words.index("--") if "--" in words else len(words)
    programs, more = words[:at], words[at + 1:]
    build("bench", needs=["--peers" if not programs or "peers_bench" in programs else "--bench"])
    here = machine()
    environment = {name: value for name, value in os.environ.items() if name != "IST_QUICK"}
    runner = Runner(here.results, here.context, quick=False, environment=environment)
    for program in programs or sorted(file.name for file in PROGRAMS.glob("*_bench")):
        runner.measure(program, program, more, shown=True)


if __name__ == "__main__":
    main(sys.argv[1:])
