#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "ist/mesh/mesh.h"

namespace ist::test {

/// Returns how often a mesh goes round a point: the sum of its triangles' solid angles. It is no
/// whole number for an open mesh. Rounding matters near the surface only.
/// Source: A. van Oosterom, J. Strackee, The solid angle of a plane triangle, IEEE Transactions on
/// Biomedical Engineering 30(2), 1983.
[[nodiscard]] inline double winding_by_angles(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p,
                          c = mesh.vertices[t[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

}  // namespace ist::test
