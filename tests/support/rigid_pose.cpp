#include "support/rigid_pose.h"

#include <array>

namespace ist::test {
namespace {

using Rows = std::array<std::array<double, 3>, 3>;

double in_order(double a, double b, double c) { return (a + b) + c; }

Rows nearer(const Rows& r) {
  Rows rest;  // 3 − RᵀR
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double gram = in_order(r[0][i] * r[0][j], r[1][i] * r[1][j], r[2][i] * r[2][j]);
      rest[i][j] = (i == j ? 3.0 : 0.0) - gram;
    }
  }
  Rows next;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      next[i][j] = in_order(r[i][0] * rest[0][j], r[i][1] * rest[1][j], r[i][2] * rest[2][j]) / 2;
    }
  }
  return next;
}

}  // namespace

Eigen::Isometry3d rigid_pose(const Eigen::Isometry3d& pose) {
  Rows rows;
  for (std::size_t i = 0; i < 9; ++i) {
    rows[i / 3][i % 3] = pose(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3));
  }
  rows = nearer(nearer(nearer(rows)));
  Eigen::Isometry3d rigid = pose;
  for (std::size_t i = 0; i < 9; ++i) {
    rigid(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) = rows[i / 3][i % 3];
  }
  return rigid;
}

}  // namespace ist::test
