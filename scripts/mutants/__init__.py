"""Ways to break the code, each of which some test must notice. mutate.py runs them."""

from . import bodies, loop, meshes, page, pair_cache, project, promises, query, sweeps, tools, tree, triangles, worlds

MUTANTS = [mutant for room in (query, pair_cache, tree, meshes, triangles, loop, bodies, tools, promises, worlds, sweeps, page, project)
           for mutant in room.MUTANTS]
