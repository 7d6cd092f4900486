#pragma once

#include <Eigen/Geometry>

#include "ist/base/pose.h"

namespace ist {

/// Six coordinates of the poses near a given one: the way of the load point along the fixed axes,
/// then the rotation vector about it. A coordinate that is held stays 0.
class SettleFrame {
 public:
  /// @param pose rigid
  /// @param load the load point, moving coordinates
  SettleFrame(const Eigen::Isometry3d& pose, const Eigen::Vector3d& load) noexcept;

  /// Returns the pose at some coordinates.
  [[nodiscard]] Eigen::Isometry3d pose_at(const Vector6& at) const noexcept;
  /// Returns the load point there, fixed coordinates.
  [[nodiscard]] Eigen::Vector3d load_at(const Vector6& at) const noexcept;
  /// Returns a bound n · (v + w × arm) >= b of a motion from some coordinates, about the load
  /// point, as a bound of the change of the coordinates.
  [[nodiscard]] Vector6 bound_at(const Vector6& at, const Eigen::Vector3d& normal,
                                 const Eigen::Vector3d& arm) const noexcept;
  /// Returns the turn about the load point that a small change of the last three coordinates makes.
  [[nodiscard]] Eigen::Vector3d turn_at(const Vector6& at,
                                        const Eigen::Vector3d& change) const noexcept;

 private:
  double rotation_[3][3];  // of the pose
  double load_[3];         // moving coordinates
  double place_[3];        // the load point at the pose, fixed coordinates
};

}  // namespace ist
