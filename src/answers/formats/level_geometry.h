#pragma once

#include "answers/formats/poly_data.h"
#include "ist/base/progress.h"
#include "ist/tree/sphere_tree.h"

namespace ist::answers {

/// Returns the cubes of a level's nodes as quads, in mesh coordinates: the faces that no neighbour
/// hides, counter-clockwise as seen from outside, and each of their corners once. Precondition: 0
/// <= level <= tree.depth(). Counts nodes in `progress`, if there is one. Cost: O(n log n); memory,
/// some 200 bytes a node.
[[nodiscard]] PolyData level_cubes(const SphereTree& tree, int level, Progress* progress = nullptr);

/// Returns the centres of a level's spheres, in mesh coordinates and the octree's order, with a
/// point array "radius". Preconditions: tree.has(policy), 0 <= level <= tree.depth().
[[nodiscard]] PolyData level_centres(const SphereTree& tree, SpherePolicy policy, int level);

}  // namespace ist::answers
