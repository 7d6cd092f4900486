#pragma once

#include <Eigen/Geometry>

#include "ist/tree/sphere_tree.h"

namespace ist::test {

/// The rigid motion that every answer is about, from the guarantee and not from the library:
/// R ← R (3 − RᵀR) / 2, three times, or four where an entry of RᵀR − I exceeds 1e-5, in double and
/// in the order that docs/guarantees.md states. Precondition: the pose is accepted.
[[nodiscard]] Eigen::Isometry3d rigid_pose(const Eigen::Isometry3d& pose);

/// That motion from the moving tree's frame to the fixed tree's, composed in rationals and rounded
/// once.
[[nodiscard]] Eigen::Isometry3d between_frames(const Eigen::Isometry3d& pose,
                                               const SphereTree& fixed, const SphereTree& moving);

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
