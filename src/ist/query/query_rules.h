#pragma once

#include "ist/query/contact.h"
#include "ist/tree/sphere_tree.h"

/// What is the same in every engine, because its answer depends on it.
namespace ist {

/// What a test of two bounds in double may err by, mesh units: a reach is grown by so much.
///
/// @param reaches  of both trees, added
/// @param farthest the largest coordinate, without its sign, of the translation between their
///                 frames
[[nodiscard]] inline double slack_in_double(double reaches, double farthest) noexcept {
  // In parts of the two reaches and the translation t between the frames, with u = 2⁻⁵³: a centre
  // errs by 4u of its length, and the moving one by 6u more, for √3 · 3u of rotation and a sum; t
  // by 3u of its own; the distance and the sum of radii, equal where it matters, by 5u; the
  // rotation's being a little off orthonormal costs 4u of a moving radius. No length is counted for
  // more than 11u.
  //
  // A slab is tested where the balls touch, so the centres are no farther apart than both radii.
  // The centres err as above. A height over the moving slab errs by 10u of the distance more, 5u
  // for its turned normal, 4u for difference and product and 1u for the offset taken off; by 1u of
  // the offset, 3u of the half width and 3u of the other radius, for what they are and their sum;
  // and by 8u and 4u of the radii for the rotation. Offset and half width are less than the cube's
  // edge, and that is less than the reach: no length is counted for more than 22u.
  constexpr double kRounding = 24 * 0x1p-53;
  return kRounding * reaches + kRounding * kSqrt3 * farthest;
}

/// Whether the cubes of one tree at `level`, of that edge, are opened where they meet those of the
/// other: they are, down to the leaves, unless the other's can be and have over √2 times the edge.
[[nodiscard]] inline bool opens(int level, double edge, int other_level,
                                double other_edge) noexcept {
  constexpr double kLarger = 1.4142135623730951;
  return level > 0 && (other_level == 0 || other_edge <= kLarger * edge);
}

/// Surfaces in a contact are no farther apart, mesh units: 2 (rA + rB) + pad, with rA and rB the
/// largest leaf radii of the two trees.
[[nodiscard]] inline double resolution_of(const QueryResult& result, const SphereTree& fixed,
                                          const SphereTree& moving, SpherePolicy policy) noexcept {
  return 2 * (fixed.largest_leaf_radius(policy) + moving.largest_leaf_radius(policy)) + result.pad;
}

}  // namespace ist
