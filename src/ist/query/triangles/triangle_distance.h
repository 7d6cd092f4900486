#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>

#include "ist/mesh/triangles_meet.h"
#include "ist/query/query.h"
#include "ist/query/results.h"
#include "simd/triangles/closest.h"

namespace ist {

/// Returns the square of the distance between two triangles that have no point in common; they may
/// be segments or points. The distance is right to within 2^-24 of the longest edge or of the
/// distance, whichever is larger (kTriangleDistanceError). Cost: 0.3 µs.
[[nodiscard]] double distance_squared(const TriangleCorners& a, const TriangleCorners& b) noexcept;

inline constexpr double kTriangleDistanceError = 0x1p-24;
/// The distance of triangles that do not intersect, if their closest points are the same in double:
/// so that 0 says that they do.
inline constexpr double kLeastDistance = 0x1p-1022;

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

/// Returns the closest points of two triangles: a common point if they intersect, which is decided
/// exactly. `triangles` are their indices. Cost: 0.4 µs.
[[nodiscard]] NearPair closest_points(const TriangleCorners& a, const TriangleCorners& b,
                                      TrianglePair triangles) noexcept;

/// Returns the same for triangles whose ClosestParts are known. Cost: 0.1 µs.
[[nodiscard]] NearPair closest_points(const TriangleCorners& a, const TriangleCorners& b,
                                      TrianglePair triangles, std::size_t parts) noexcept;

/// Finds the parts of two triangles that are no farther apart than `enough`: each corner above the
/// other's face, and of each two edges the points that are closest. No two have the same parts.
/// They are in the order of their distance. Returns their number. Cost: 0.5 µs.
///
/// One closest point does not describe how two triangles may move: an edge that lies along a face
/// would turn into it.
IST_LOOP_API std::size_t near_parts(const TriangleCorners& a, const TriangleCorners& b,
                                    TrianglePair triangles, double enough,
                                    std::span<NearPair, Query::kMostNearParts> out) noexcept;

/// Returns whether a plane across `way` certainly parts two triangles. The gap between them is
/// measured along any vector. Its rounding is allowed for.
/// @param near  a point near both triangles, from which coordinates are taken
/// Cost: 10 ns.
[[nodiscard]] IST_LOOP_API bool surely_parted(const TriangleCorners& a, const TriangleCorners& b,
                                              const Eigen::Vector3d& near,
                                              const Eigen::Vector3d& way) noexcept;

/// Returns a pose in plain numbers, which moves a point as RigidMove does.
[[nodiscard]] PlainMove plain_move(const Eigen::Isometry3d& pose) noexcept;

}  // namespace ist
