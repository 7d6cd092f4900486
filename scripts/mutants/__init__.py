"""Ways to break the code, each of which some test must notice. mutate.py runs them."""

from . import bodies, fronts, loop, meshes, page, project, promises, query, sweeps, tools, tree, triangles, worlds

MUTANTS = [mutant for room in (query, fronts, tree, meshes, triangles, loop, bodies, tools, promises, worlds, sweeps, page, project)
           for mutant in room.MUTANTS]
