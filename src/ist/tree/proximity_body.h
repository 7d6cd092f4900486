#pragma once

#include "ist/base/api.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// The proximity voxels of a tree as a body of their own, in the same mesh coordinates: the points
/// at their centres, bounded tightly, one a leaf. What touches it is near the outside of the
/// surface; a leaf of another body in voxels as large touches about one of them, and not all twenty
/// cells whose spheres it meets. It has no normals. Precondition: the tree has proximity voxels.
/// Cost: 1 µs a voxel.
[[nodiscard]] IST_API SphereTree proximity_body(const SphereTree& tree);

}  // namespace ist
