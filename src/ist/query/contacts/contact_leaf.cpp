#include "ist/query/contacts/contact_leaf.h"

#include "ist/base/set_bits.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

// Returns the centre of a node's cube, in voxel edges from the root cube's centre.
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
    const Eigen::Vector3d cube = cube_centre_of(tree.parts().octree, level, node, parent);
    const Ball ball = tree.parts().ball(policy, level, node, cube);
    bound.centre = ball.centre;
    bound.radius = ball.radius;
    return bound;
  }
  const auto slot = static_cast<int>(node - tree.parts().octree.first_child(level + 1, parent));
  const Ball ball = tree.parts().saved_ball(level, parent, slot);
  bound.centre = ball.centre;
  bound.radius = ball.radius;
  if (policy != SpherePolicy::kSlab) return bound;
  const Slab slab = tree.parts().saved_slab(level, parent, slot);
  bound.normal = slab.normal;
  bound.offset = slab.offset;
  bound.half = slab.half;
  return bound;
}

ContactLeaf read_leaf(const SphereTree& tree, SpherePolicy policy, std::uint32_t leaf,
                      std::uint32_t parent) noexcept {
  const NodeBound bound = read_bound(tree, policy, 0, leaf, parent);
  ContactLeaf result{bound, bound.centre, Eigen::Vector3d::Zero()};
  const double length2 = dot_in_order(bound.normal, bound.normal);
  if (length2 > 0) add_to(result.point, scaled(bound.offset / length2, bound.normal));
  const PackedNormal normal = tree.parts().normals[leaf];
  result.normal = scaled(normal.coherence(), normal.direction());
  return result;
}

}  // namespace ist
