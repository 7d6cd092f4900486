"""What a mutant is, and the places and the tests that several of them name."""

from typing import NamedTuple


class Mutant(NamedTuple):
    name: str
    breaks: str  # what it does, for perf/MUTANTS.md
    edits: list  # (file, a passage that is there once, what stands there instead)
    # In the order in which they are asked: a program; a program and a filter; "ctest" and a name; "node" and a file of tests/viewer;
    # "python" and a file of tests/scripts, of which a class alone where one is named.
    tests: list


SEARCH_POSE = "src/ist/query/traversal/search_pose.cpp"
LANES = "simd/lanes.h"
BOUNDS_INL = "simd/bounds-inl.h"
MEASURE_INL = "simd/measure-inl.h"
PAIR_ROWS_INL = "simd/step_vector.cpp"
SHARED = "src/ist/query/workers/shared_search.cpp"
NODE_BOUNDS = "src/ist/tree/node_bounds.cpp"
LEAF_SEARCH = "src/ist/tree/leaf_search.cpp"
VOXELIZER = "src/ist/voxel/voxelizer.cpp"
BINS = "src/ist/voxel/triangle_bins.cpp"
BOX = "src/ist/voxel/triangle_bins.h"
TRIANGLES = "src/ist/query/triangles/"
CONTACTS = "src/ist/query/contacts/"
MEASURE = "src/ist/measure/"
PAIR_CACHE = "src/ist/query/pair_cache/"
PAIR_CACHE_INL = "simd/pair_cache-inl.h"
PAIR_CACHE_STEP = "simd/pair_cache_step.h"
PAIR_CACHE_SCALAR = "simd/step_scalar.cpp"
WORLD = "src/ist/query/world/"
QUERY_STATE = "src/ist/query/query_state.cpp"
ADVICE = "src/advise/"
CAPI = "src/ist/capi/"
HAPTICS = "src/ist/haptics/"
HARDWARE = "src/hardware/"
FORMAT = "src/ist/mesh/format/"
BITES = "src/answers/occlusion/"
OCCLUSION = "src/cli/occlusion/"
PAGES = "src/cli/pages/"
PAGE = "src/viewer/page/"
PAGE_DATA = "src/cli/page/"
CIRCUIT = HARDWARE + "rtl/ist_pair_test.v"
SIMULATION = HAPTICS + "simulation.cpp"
FRICTION = HAPTICS + "effects/friction_effect.cpp"

TANGENCY = "stability_test *Tangency*"
KERNELS = "search_test *Border*:*Advance*"
GUARANTEE = "search_test *Guarantee*-*Thread*"
CACHES = "search_test *Cache*"
COHERENT_ANSWERS = "pair_cache_test *CoherentQuery.*"
