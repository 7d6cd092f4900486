#pragma once

#include "ist/base/api.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// Returns the proximity voxels of a tree as a body in the same mesh coordinates: the points at
/// their centres, bounded tightly, one a leaf, without normals. A body that intersects this one is
/// near the outside of the surface. A leaf of a body with voxels of the same size overlaps about
/// one leaf here, not all twenty cells whose spheres it overlaps. Precondition: the tree has
/// proximity voxels.
/// Cost: 1 µs a voxel.
[[nodiscard]] IST_LOOP_API SphereTree proximity_body(const SphereTree& tree);

}  // namespace ist
