#pragma once

#include "ist/mesh/triangles_meet.h"

namespace ist {

/// Returns the square of the distance between two triangles that have no point in common; they may
/// be segments or points. The distance is right to within 2^-24 of the longest edge or of the
/// distance, whichever is larger (kTriangleDistanceError). Cost: 0.3 µs.
[[nodiscard]] double distance_squared(const TriangleCorners& a, const TriangleCorners& b) noexcept;

inline constexpr double kTriangleDistanceError = 0x1p-24;

/// Returns the square of the distance between the axis-aligned boxes round two triangles, 0 where
/// they overlap: no more than that of the triangles, but for two roundings.
[[nodiscard]] double box_distance_squared(const TriangleCorners& a,
                                          const TriangleCorners& b) noexcept;

/// Returns true if it is certain, after a few iterations, that two triangles are farther apart than
/// `distance`: each iteration tries the vector between the closest points so far as a separating
/// axis. Right to within kTriangleDistanceError, like the distance; false decides nothing. Cost: 20
/// ns an iteration. Source: E. G. Gilbert, An iterative procedure for computing the minimum of a
/// quadratic form on a convex set, SIAM Journal on Control 4, 1966.
[[nodiscard]] bool surely_farther(const TriangleCorners& a, const TriangleCorners& b,
                                  double distance) noexcept;

}  // namespace ist
