#pragma once

#include <Eigen/Geometry>

namespace ist::test {

/// The closing that is measured: the lower jaw turned by 0.0003 rad about z, so that no face of one
/// body is parallel to one of the other, and moved by `dz` along z, mm.
[[nodiscard]] inline Eigen::Isometry3d closing(double dz) {
  constexpr double kTurn = 0.0003;  // small enough for two terms of the series
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.matrix()(0, 0) = pose.matrix()(1, 1) = 1 - kTurn * kTurn / 2;
  pose.matrix()(1, 0) = kTurn - kTurn * kTurn * kTurn / 6;
  pose.matrix()(0, 1) = -pose.matrix()(1, 0);
  pose.translation()[2] = dz;
  return pose;
}

}  // namespace ist::test
