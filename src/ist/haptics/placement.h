#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "ist/base/api.h"

namespace ist {

/// A motion, a force or a change of either, in six numbers: first what belongs to translation, then
/// what belongs to rotation. A motion is in metres and radians, a velocity in m/s and rad/s, a
/// wrench in N and N m about the tool's origin; axes are those of the scene.
using Vector6 = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;
/// How a wrench changes with a motion: N/m, N and N m. Layouts hang on no instruction set.
using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;

/// Where the tool is: from its own frame to the scene's, both in metres. The tool's origin is the
/// centre of the held body's grid.
struct IST_API Placement {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] Eigen::Isometry3d isometry() const noexcept;
  /// Nothing where it is no rigid motion (project_to_rigid).
  [[nodiscard]] static std::optional<Placement> from(const Eigen::Isometry3d& pose) noexcept;

  /// After a small motion about the tool's origin. The turn is that of the quaternion
  /// (1, motion/2), which is the motion's angle to within its cube/12 and needs no sine; the result
  /// is rigid to a few 1e-16 however often it is moved. Precondition: finite.
  [[nodiscard]] Placement moved(const Vector6& motion) const noexcept;
  /// The same in a third of the time, but that each motion leaves it less rigid by some 1e-16: for
  /// a few hundred in a row, after which moved() puts it right.
  [[nodiscard]] Placement nudged(const Vector6& motion) const noexcept;
};

/// The motion from one placement to another: `from.moved(motion_between(from, to))` is `to` to
/// within rounding for turns of less than half a circle. Long turns count for more than their
/// angle, twice its half's tangent; from 4e-3 short of half a circle they are cut at 1e3, along
/// their axis. At just half a circle either sense will do.
[[nodiscard]] IST_API Vector6 motion_between(const Placement& from, const Placement& to) noexcept;

}  // namespace ist
