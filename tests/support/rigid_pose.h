#pragma once

#include <Eigen/Geometry>

namespace ist::test {

/// The rigid motion that every answer is about, from the guarantee and not from the library:
/// R ← R (3 − RᵀR) / 2, three times, in double and in the order that docs/guarantees.md states.
/// Precondition: the pose is accepted.
[[nodiscard]] Eigen::Isometry3d rigid_pose(const Eigen::Isometry3d& pose);

}  // namespace ist::test
