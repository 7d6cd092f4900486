#pragma once

#include <Eigen/Core>
#include <array>

namespace ist {

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
