#pragma once

#include "ist/query/exact/triangles_meet.h"

namespace ist {

/// The square of the distance between two triangles that have no point in common; they may be
/// segments or points. Right to within 2^-24 of the longest edge or of the distance, whichever is
/// larger (kTriangleDistanceError). Cost: 0.3 µs.
[[nodiscard]] double distance_squared(const TriangleCorners& a, const TriangleCorners& b) noexcept;

inline constexpr double kTriangleDistanceError = 0x1p-24;

/// The square of the distance between two boxes round points, 0 where they overlap: no more than
/// that of what is in them, but for two roundings.
[[nodiscard]] double box_distance_squared(const TriangleCorners& a,
                                          const TriangleCorners& b) noexcept;

/// Whether it is certain, after a few looks, that two triangles are farther apart than `distance`:
/// each look is along the vector between the two points that are nearest so far. Right to within
/// kTriangleDistanceError, as the distance is. False decides nothing. Cost: 20 ns a look.
/// Source: E. G. Gilbert, An iterative procedure for computing the minimum of a quadratic form on a
/// convex set, SIAM Journal on Control 4, 1966.
[[nodiscard]] bool surely_farther(const TriangleCorners& a, const TriangleCorners& b,
                                  double distance) noexcept;

}  // namespace ist
