#pragma once

#include <cmath>
#include <numbers>

#include "support/shapes.h"

namespace ist::test {

/// A V groove of 90 degrees along x, its bottom at z = 0, in a block. `width` is half of its own.
inline TriangleMesh v_groove(double width, double length) {
  TriangleMesh mesh;
  const double y[] = {-width, width, width, 0, -width}, z[] = {-width, -width, width, 0, width};
  for (const double x : {-length, length}) {
    for (int i = 0; i < 5; ++i) mesh.vertices.emplace_back(x, y[i], z[i]);
  }
  for (std::uint32_t i = 0; i < 5; ++i) {
    const std::uint32_t j = (i + 1) % 5;
    mesh.triangles.push_back({i, j + 5, j});
    mesh.triangles.push_back({i, i + 5, j + 5});
  }
  constexpr std::uint32_t kEnds[3][3] = {{0, 1, 3}, {1, 2, 3}, {0, 3, 4}};
  for (const auto& [a, b, c] : kEnds) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a + 5, c + 5, b + 5});
  }
  return mesh;
}

/// A cone's pit in a block: `sides` sides, its apex at the origin, its axis along z.
inline TriangleMesh conical_pit(double half_angle, double depth, int sides) {
  const double width = depth * std::tan(half_angle);
  return revolved({{0, -depth}, {width, -depth}, {width, depth}, {0, 0}}, sides);
}

/// A turn about an axis by an angle, about a point.
inline Eigen::Isometry3d turn_about(const Eigen::Vector3d& point, const Eigen::Vector3d& axis,
                                    double angle) {
  return Eigen::Translation3d(point) * Eigen::AngleAxisd(angle, axis.normalized()) *
         Eigen::Translation3d(-point);
}

}  // namespace ist::test
