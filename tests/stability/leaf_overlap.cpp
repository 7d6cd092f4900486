#include "stability/leaf_overlap.h"

#include "ist/base/set_bits.h"
#include "ist/tree/tree_parts.h"
#include "verify/read_bounds.h"

namespace ist::test {
namespace {

// The centre of a leaf's cube, in voxels from the root cube's.
Eigen::Vector3d cube_centre(const LinearOctree& octree, std::uint32_t leaf) {
  if (octree.depth() == 0) return Eigen::Vector3d::Zero();
  const std::uint32_t parent = parent_of(octree, 0, leaf);
  const auto& at = octree.nodes(1)[parent].centre;
  Eigen::Vector3d centre(at[0], at[1], at[2]);
  const unsigned octant = kSetBits[octree.mask(1, parent)][leaf - octree.first_child(1, parent)];
  for (unsigned axis = 0; axis < 3; ++axis) centre[axis] += (octant >> axis & 1) != 0 ? 0.5 : -0.5;
  return centre;
}

Bounds bounds_of(const SphereTree& tree, SpherePolicy policy, std::uint32_t leaf) {
  if (!is_implicit(policy)) return read_bounds(tree, policy, leaf);
  return {parts_of(tree).ball(policy, 0, leaf, cube_centre(parts_of(tree).octree, leaf)), {}};
}

}  // namespace

double leaf_overlap(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                    const Eigen::Isometry3d& between, const LeafPair& pair) {
  return overlap(policy, bounds_of(fixed, policy, pair.fixed),
                 moved(between, bounds_of(moving, policy, pair.moving)));
}

}  // namespace ist::test
