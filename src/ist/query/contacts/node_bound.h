#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ist/query/contacts/plain_vector.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// The bound of an octree node as the search tests it, in double and without any pad, in a tree's
/// frame, mesh units: a ball, and with kSlab the slab |normal · (x - centre) - offset| <= half.
struct NodeBound {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< no longer than 1
  double offset = 0, half = 0;

  /// Moved to the fixed tree's frame.
  [[nodiscard]] NodeBound in(const RelativePose& pose) const noexcept {
    return {moved(pose, centre), radius, turned(pose, normal), offset, half};
  }
  /// Two bounds that are both grown by the same overlap by so much more.
  [[nodiscard]] NodeBound grown(double by) const noexcept {
    return {centre, radius + 0.5 * by, normal, offset, half + 0.5 * by};
  }
};

/// Of the node at `level` that is a child of `parent` at level + 1; slabs are read for kSlab alone.
/// Precondition: tree.has(policy). Cost: 10 ns.
[[nodiscard]] NodeBound read_bound(const SphereTree& tree, SpherePolicy policy, int level,
                                   std::uint32_t node, std::uint32_t parent) noexcept;

/// How far the slabs of two bounds in one frame overlap the other's ball, mesh units: the search
/// drops a pair only where this is less than 0.
[[nodiscard]] inline double slab_overlap(const NodeBound& a, const NodeBound& b) noexcept {
  const Eigen::Vector3d between = difference(b.centre, a.centre);
  const double over_a = std::abs(dot_in_order(a.normal, between) - a.offset);
  const double over_b = std::abs(dot_in_order(b.normal, between) + b.offset);
  return std::min((a.half + b.radius) - over_a, (b.half + a.radius) - over_b);
}

}  // namespace ist
