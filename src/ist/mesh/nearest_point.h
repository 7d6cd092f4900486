#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace ist {

/// A point of a triangle and its feature: corner 0, 1 or 2; edge 3, 4 or 5, from corner 0, 1 or 2
/// to the next one; or kInside.
struct NearestPoint {
  static constexpr int kInside = 6;
  Eigen::Vector3d point;
  int feature;
};

/// The triangle of a mesh that is nearest to a point.
struct NearestTriangle {
  double square;  ///< of the distance, mesh units squared
  std::uint32_t triangle;
  NearestPoint on;       ///< mesh coordinates
  bool is_tied = false;  ///< another corner, edge or face is as near, to within rounding
};

/// Returns the point of a triangle nearest to `point`, with its feature.
///
/// Source: C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
[[nodiscard]] NearestPoint nearest_on_triangle(const std::array<Eigen::Vector3d, 3>& triangle,
                                               const Eigen::Vector3d& point) noexcept;

}  // namespace ist
