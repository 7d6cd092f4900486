#include "verify/read_bounds.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace ist {

std::uint32_t parent_of(const LinearOctree& octree, int level, std::uint32_t node) noexcept {
  const std::span<const OctreeNode> parents = octree.nodes(level + 1);
  const auto after =
      std::upper_bound(parents.begin(), parents.end(), node,
                       [](std::uint32_t n, const OctreeNode& p) { return n < p.first_child; });
  return static_cast<std::uint32_t>(after - parents.begin() - 1);
}

Bounds read_bounds(const SphereTree& tree, SpherePolicy policy, std::uint32_t leaf) noexcept {
  const std::uint32_t parent = parent_of(voxels_of(tree).octree, 0, leaf);
  const auto slot = static_cast<int>(leaf - voxels_of(tree).octree.nodes(1)[parent].first_child);
  Bounds bounds{voxels_of(tree).saved_ball(0, parent, slot), {}};
  if (policy == SpherePolicy::kSlab) bounds.slab = voxels_of(tree).saved_slab(0, parent, slot);
  return bounds;
}

Bounds moved(const Eigen::Isometry3d& motion, Bounds bounds) noexcept {
  bounds.ball.centre = motion * bounds.ball.centre;
  bounds.slab.normal = motion.linear() * bounds.slab.normal;
  return bounds;
}

double overlap(SpherePolicy policy, const Bounds& a, const Bounds& b) noexcept {
  const Eigen::Vector3d apart = b.ball.centre - a.ball.centre;
  double least = a.ball.radius + b.ball.radius - apart.norm();
  if (policy != SpherePolicy::kSlab) return least;
  const auto into = [](const Slab& slab, const Eigen::Vector3d& centre, double radius) {
    return slab.half + radius - std::abs(slab.normal.dot(centre) - slab.offset);
  };
  least = std::min(least, into(a.slab, apart, b.ball.radius));
  return std::min(least, into(b.slab, -apart, a.ball.radius));
}

}  // namespace ist
