#pragma once

#include <Eigen/Geometry>

#include "ist/base/ordered_vector.h"

namespace ist {

/// Moves points in double: v becomes ((r₀₀ v₀ + r₀₁ v₁) + r₀₂ v₂) + t₀ and so on, with no product
/// fused to a sum. (Not an Isometry3d, whose alignment depends on the instruction set.)
class RigidMove {
 public:
  /// Precondition: `pose` is rigid.
  explicit RigidMove(const Eigen::Isometry3d& pose) noexcept
      : rotation_(pose.linear()), translation_(pose.translation()) {}

  [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& v) const noexcept {
    return sum(turned(v), translation_);
  }

  /// Turns a direction, which has no place.
  [[nodiscard]] Eigen::Vector3d turned(const Eigen::Vector3d& v) const noexcept {
    const Eigen::Matrix3d& r = rotation_;
    Eigen::Vector3d at;
    for (Eigen::Index i = 0; i < 3; ++i) {
      at[i] = (r(i, 0) * v[0] + r(i, 1) * v[1]) + r(i, 2) * v[2];
    }
    return at;
  }

 private:
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d translation_;
};

/// Returns Rᵀ and -Rᵀ t of a rigid pose R, t, in the order of RigidMove.
[[nodiscard]] Eigen::Isometry3d inverse_of(const Eigen::Isometry3d& pose) noexcept;

}  // namespace ist
