#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ist/query/relative_pose.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// The bound of an octree node as the search tests it, in double and without pad, in a tree's
/// frame, mesh units: a ball, and with kSlab the slab |normal · (x - centre) - offset| <= half.
struct NodeBound {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< no longer than 1
  double offset = 0, half = 0;

  /// Returns the bound in the fixed tree's frame.
  [[nodiscard]] NodeBound in(const RelativePose& pose) const noexcept {
    return {moved(pose, centre), radius, turned(pose, normal), offset, half};
  }
  /// Returns the bound with a larger radius and half width: two bounds inflated `by` the same
  /// length overlap by that length more.
  [[nodiscard]] NodeBound inflated(double by) const noexcept {
    return {centre, radius + 0.5 * by, normal, offset, half + 0.5 * by};
  }
};

/// Reads the bound of the node at `level` that is a child of `parent` at level + 1; reads slabs for
/// kSlab alone. Precondition: tree.has(policy). Cost: 10 ns.
[[nodiscard]] NodeBound read_bound(const SphereTree& tree, SpherePolicy policy, int level,
                                   std::uint32_t node, std::uint32_t parent) noexcept;

/// Returns the overlap of each bound's slab with the other bound's ball, the lesser of the two,
/// mesh units, both bounds in one frame. The search drops a pair only where this is negative.
[[nodiscard]] inline double slab_overlap(const NodeBound& a, const NodeBound& b) noexcept {
  const Eigen::Vector3d between = difference(b.centre, a.centre);
  const double over_a = std::abs(dot_in_order(a.normal, between) - a.offset);
  const double over_b = std::abs(dot_in_order(b.normal, between) + b.offset);
  return std::min((a.half + b.radius) - over_a, (b.half + a.radius) - over_b);
}

/// The properties of a leaf from which contacts are computed, in a tree's frame, mesh units.
struct ContactLeaf {
  NodeBound bound;
  /// A point near the surface: on the slab's middle plane, at the tight ball's centre, or at the
  /// cube's centre, as the policy permits.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// The outward normal; its length is the coherence of the voxel's normals, 0 … 1.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();

  /// Returns the leaf in the fixed tree's frame.
  [[nodiscard]] ContactLeaf in(const RelativePose& pose) const noexcept {
    return {bound.in(pose), moved(pose, point), turned(pose, normal)};
  }
};

/// The largest distance from the ball's centre to the surface point, in voxel sizes: half the
/// cube's edge, the bound of PackedSlab's offset, divided by the least length of a packed normal.
inline constexpr double kFarthestPoint = 0.52;

/// Reads a leaf; `parent` is its parent, at level 1. Precondition: tree.has(policy). Cost: 20 ns.
[[nodiscard]] ContactLeaf read_leaf(const SphereTree& tree, SpherePolicy policy, std::uint32_t leaf,
                                    std::uint32_t parent) noexcept;

}  // namespace ist
