"""Ways to break the code, each of which some test must notice. mutate.py runs them."""

from typing import NamedTuple

from . import loop, meshes, search, tools


class Mutant(NamedTuple):
    name: str
    breaks: str  # what it does, for perf/MUTANTS.md
    edits: list  # (file, a passage that is there once, the passage that replaces it)
    # In the order in which they are asked: a program; a program and a filter; "ctest" and a name; "node" and a file of tests/viewer;
    # "python" and a file of tests/scripts, and if only one of its classes is asked, that class.
    tests: list


MUTANTS = [Mutant(*row) for room in (search, meshes, loop, tools) for row in room.MUTANTS]
