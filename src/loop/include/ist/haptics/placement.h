#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "ist/base/api.h"
#include "ist/base/pose.h"

namespace ist {

/// The pose of the tool: a map from the tool's frame to the scene's, both in metres. The tool's
/// origin is the middle of the held body's box, or the point that the scene names.
struct IST_API Placement {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< tool axes to scene axes
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();   ///< of the tool's origin, m

  /// Converts to a pose, in metres.
  [[nodiscard]] Eigen::Isometry3d isometry() const noexcept;
  /// Converts a pose. Empty if the pose is no rigid motion (project_to_rigid).
  [[nodiscard]] static std::optional<Placement> from(const Eigen::Isometry3d& pose) noexcept;

  /// Moves the placement by a small motion about the tool's origin. The rotation is that of the
  /// quaternion (1, motion/2), which equals the motion's angle to within a twelfth of its cube and
  /// needs no sine. The result is rigid to a few 1e-16 after any number of motions. Precondition:
  /// the motion is finite.
  [[nodiscard]] Placement moved(const Vector6& motion) const noexcept;
  /// Moves the placement in a third of the time of moved(), without restoring rigidity: each call
  /// adds an error of some 1e-16. Call moved() after a few hundred.
  [[nodiscard]] Placement integrated_fast(const Vector6& motion) const noexcept;
};

/// Computes the motion from one placement to another: `from.moved(motion_between(from, to))` equals
/// `to` to within rounding for turns of less than half a circle. A turn counts as twice the tangent
/// of half its angle, at most 1e3, which is reached 4e-3 rad short of half a circle. At half a
/// circle the sense of the turn is arbitrary.
[[nodiscard]] IST_API Vector6 motion_between(const Placement& from, const Placement& to) noexcept;

}  // namespace ist
