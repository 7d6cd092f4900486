#pragma once

#include <Eigen/Core>
#include <array>

namespace ist {

/// A convex polygon in space: a triangle cut by the six planes of a box. That makes nine corners at
/// most, and rounding may add a few.
struct ClippedTriangle {
  static constexpr int kMaxCorners = 12;
  std::array<Eigen::Vector3d, kMaxCorners> corners;
  int count = 0;  ///< 0 when nothing is left

  /// Area, in the square of the coordinates' unit.
  [[nodiscard]] double area() const noexcept;
};

/// The part of a triangle inside the closed box [low, high]. Corners keep the triangle's turn.
///
/// Cost: a few ns where the triangle lies inside, some 70 where every plane cuts. Source: I. E.
/// Sutherland, G. W. Hodgman, Reentrant polygon clipping, CACM 17(1), 1974.
void clip_triangle(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& low,
                   const Eigen::Vector3d& high, ClippedTriangle& result) noexcept;

/// Where on a triangle a point lies: at corner 0, 1 or 2; on edge 3, 4 or 5, from corner 0, 1 or 2
/// to the next; or inside.
struct NearestPoint {
  static constexpr int kInside = 6;
  Eigen::Vector3d point;
  int feature;
};

/// The point of a triangle nearest to `point`.
///
/// Source: C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
[[nodiscard]] NearestPoint nearest_on_triangle(const std::array<Eigen::Vector3d, 3>& triangle,
                                               const Eigen::Vector3d& point) noexcept;

}  // namespace ist
