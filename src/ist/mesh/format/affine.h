#pragma once

#include <Eigen/Geometry>

namespace ist {

/// Moves a point by an affine transform; the sums have one order on every platform, as those of
/// RigidMove.
[[nodiscard]] Eigen::Vector3d moved_by(const Eigen::Affine3d& transform,
                                       const Eigen::Vector3d& v) noexcept;

/// Returns the transform that moves by `first` and then by `second`, in the same order.
[[nodiscard]] Eigen::Affine3d joined(const Eigen::Affine3d& second,
                                     const Eigen::Affine3d& first) noexcept;

}  // namespace ist
