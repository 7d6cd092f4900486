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

}  // namespace ist::test
