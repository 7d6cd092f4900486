"""Faults in the code. At least one test must notice each of them. mutate.py runs the tests."""

import pathlib
from typing import NamedTuple

from . import loop, meshes, search, tools

ROOT = pathlib.Path(__file__).parents[2]


class Mutant(NamedTuple):
    name: str
    breaks: str  # the fault in words, for perf/MUTANTS.md
    edits: list  # (file, a passage that the file has once, the new passage)
    # The tests in the order of their runs: a program; a program and a filter; "ctest" and a name; "node" and a file of tests/viewer;
    # "python" and a file of tests/scripts, and the name of a class to run only its tests.
    tests: list


# scripts/check_house.sh sees to it that sources and headers differ in name, so rows name them without their folders.
SOURCES = {file.name: str(file.relative_to(ROOT)) for room in ("src", "simd") for kind in ("*.h", "*.cpp") for file in (ROOT / room).rglob(kind)}
MUTANTS = [Mutant(name, breaks, [(SOURCES.get(file, file), old, new) for file, old, new in edits], tests)
           for room in (search, meshes, loop, tools) for name, breaks, edits, tests in room.MUTANTS]
