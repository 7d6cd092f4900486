#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace ist {

/// The convex hull of points as seen along a direction.
class SupportHull {
 public:
  /// @param points    any number
  /// @param direction unit vector
  SupportHull(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& direction);

  /// Returns how far the origin lies inside the hull: its distance from the border, negative
  /// outside. For points on a line the distance from the line's part between them, 0 or negative.
  /// -infinity without points.
  [[nodiscard]] double margin() const noexcept;

 private:
  struct Point {
    double x, y;
  };
  std::vector<Point> hull_;  // counterclockwise
};

}  // namespace ist
