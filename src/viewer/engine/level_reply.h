#pragma once

#include "ist/tree/sphere_tree.h"
#include "viewer/engine/reply.h"

namespace ist::viewer {

/// Fills in the balls of one level's nodes, and under `slab` the slabs that cut them, mesh
/// coordinates, in the octree's order: Level of page/protocol.js. Throws kPolicyMissing, and
/// kArgumentInvalid for a level that the tree lacks.
void fill_level(const SphereTree& tree, SpherePolicy policy, int level, Reply& reply);

}  // namespace ist::viewer
