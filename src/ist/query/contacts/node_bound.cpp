#include "ist/query/contacts/node_bound.h"

#include "ist/base/set_bits.h"

namespace ist {
namespace {

// In voxel edges from the root cube's centre.
Eigen::Vector3d cube_centre_of(const LinearOctree& octree, int level, std::uint32_t node,
                               std::uint32_t parent) noexcept {
  if (level == octree.depth()) return Eigen::Vector3d::Zero();
  const auto& from = octree.nodes(level > 0 ? level : 1)[level > 0 ? node : parent].centre;
  Eigen::Vector3d centre(from[0], from[1], from[2]);
  if (level > 0) return centre;
  const std::uint32_t slot = node - octree.first_child(1, parent);
  const unsigned octant = kSetBits[octree.mask(1, parent)][slot];
  for (unsigned axis = 0; axis < 3; ++axis) centre[axis] += (octant >> axis & 1) != 0 ? 0.5 : -0.5;
  return centre;
}

}  // namespace

NodeBound read_bound(const SphereTree& tree, SpherePolicy policy, int level, std::uint32_t node,
                     std::uint32_t parent) noexcept {
  NodeBound bound;
  if (is_implicit(policy)) {
    const Eigen::Vector3d cube = cube_centre_of(tree.octree(), level, node, parent);
    const Ball ball = tree.ball(policy, level, node, cube);
    bound.centre = ball.centre;
    bound.radius = ball.radius;
    return bound;
  }
  const auto slot = static_cast<int>(node - tree.octree().first_child(level + 1, parent));
  const Ball ball = tree.saved_ball(level, parent, slot);
  bound.centre = ball.centre;
  bound.radius = ball.radius;
  if (policy != SpherePolicy::kSlab) return bound;
  const Slab slab = tree.saved_slab(level, parent, slot);
  bound.normal = slab.normal;
  bound.offset = slab.offset;
  bound.half = slab.half;
  return bound;
}

}  // namespace ist
