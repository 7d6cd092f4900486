#pragma once

#include "ist/base/ordered_vector.h"
#include "ist/query/results.h"
#include "ist/tree/bounds.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

/// The rules that every engine must share, because the answer depends on them.
namespace ist {

/// Returns the pad of a test of two bounds in double, mesh units: an upper bound of its rounding
/// error, which is added to the sum of radii (docs/guarantees.md, Search in double).
///
/// @param bounding_radii  the bounding radii of both trees, added
/// @param farthest the largest coordinate, without its sign, of the translation between their
///                 frames
[[nodiscard]] inline double pad_in_double(double bounding_radii, double farthest) noexcept {
  // Derived: 22u of each bounding radius and 11u of the translation, u = 2⁻⁵³.
  constexpr double kRounding = 24 * 0x1p-53;
  return kRounding * bounding_radii + kRounding * kSqrt3 * farthest;
}

/// Returns whether a traversal descends into the nodes of a tree at `level`, with cubes of edge
/// `edge`, where they meet nodes of the other tree. It does, down to the leaves, unless the other
/// tree can descend and its cubes have over √2 times the edge.
[[nodiscard]] inline bool descends(int level, double edge, int other_level,
                                   double other_edge) noexcept {
  constexpr double kLarger = 1.4142135623730951;
  return level > 0 && (other_level == 0 || other_edge <= kLarger * edge);
}

/// Returns whether two balls, in one frame, are more than `pad` apart, in double. By >, so that a
/// NaN keeps the pair.
[[nodiscard]] inline bool may_touch(const Ball& a, const Ball& b, double pad) noexcept {
  const Eigen::Vector3d apart = difference(b.centre, a.centre);
  const double radius_sum = (a.radius + b.radius) + pad;
  return dot_in_order(apart, apart) > radius_sum * radius_sum;
}

/// Returns the largest distance between the surfaces in a leaf pair, mesh units: 2 (rA + rB) + pad,
/// with rA and rB the largest leaf radii of the two trees.
[[nodiscard]] inline double resolution_of(const QueryResult& result, const SphereTree& fixed,
                                          const SphereTree& moving, SpherePolicy policy) noexcept {
  return 2 * (fixed.largest_leaf_radius(policy) + moving.largest_leaf_radius(policy)) + result.pad;
}

}  // namespace ist
