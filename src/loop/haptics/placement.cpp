#include "ist/haptics/placement.h"

#include "ist/base/float_environment.h"
#include "ist/base/pose.h"

namespace ist {
namespace {

constexpr double kLongestTurn = 1e3;  // as a motion: twice the half angle's tangent
constexpr double kLeastCosine = 4 / (1 + 0.25 * kLongestTurn * kLongestTurn);  // 1 + trace there

// The rotation of the quaternion (1, half), of any length.
Eigen::Matrix3d turn_by(const Eigen::Vector3d& half) noexcept {
  const double square = half.squaredNorm();
  Eigen::Matrix3d cross;
  cross << 0, -half.z(), half.y(), half.z(), 0, -half.x(), -half.y(), half.x(), 0;
  return ((1 - square) * Eigen::Matrix3d::Identity() + 2 * (half * half.transpose()) + 2 * cross) /
         (1 + square);
}

// The axis of about half a turn, whose sine is too small for the usual formula. The symmetric part
// minus the cosine is (1 - cosine) axis axisᵀ; its longest column is the most exact. At half a turn
// the sign is arbitrary.
Eigen::Vector3d half_turn_axis(const Eigen::Matrix3d& turn, const Eigen::Vector3d& sine) noexcept {
  const double cosine = 0.5 * (turn.trace() - 1);
  const Eigen::Matrix3d square =
      0.5 * (turn + turn.transpose()) - cosine * Eigen::Matrix3d::Identity();
  int longest = 0;
  for (int i = 1; i < 3; ++i) {
    if (square(i, i) > square(longest, longest)) longest = i;
  }
  const Eigen::Vector3d axis = square.col(longest) / square.col(longest).norm();
  return axis.dot(sine) < 0 ? Eigen::Vector3d(-axis) : axis;
}

}  // namespace

Eigen::Isometry3d Placement::isometry() const noexcept {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation;
  pose.translation() = translation;
  return pose;
}

std::optional<Placement> Placement::from(const Eigen::Isometry3d& pose) noexcept {
  const auto rigid = project_to_rigid(pose);
  if (!rigid) return std::nullopt;
  return Placement{rigid->linear(), rigid->translation()};
}

Placement Placement::integrated_fast(const Vector6& motion) const noexcept {
  const ScopedFloatEnvironment environment;
  return {turn_by(0.5 * motion.tail<3>()) * rotation, translation + motion.head<3>()};
}

Placement Placement::moved(const Vector6& motion) const noexcept {
  const Placement after = integrated_fast(motion);
  // Products of many rotations drift from rigid; this projects them back.
  const auto rigid = project_to_rigid(after.isometry());
  return {rigid ? Eigen::Matrix3d(rigid->linear()) : rotation, after.translation};
}

Vector6 motion_between(const Placement& from, const Placement& to) noexcept {
  const ScopedFloatEnvironment environment;
  const Eigen::Matrix3d turn = to.rotation * from.rotation.transpose();
  // With the half angle's tangent t: the antisymmetric part is 2t/(1 + t²), 1 + trace 4/(1 + t²).
  const Eigen::Vector3d sine(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0),
                             turn(1, 0) - turn(0, 1));
  const double cosine = 1 + turn.trace();
  Vector6 motion;
  motion.head<3>() = to.translation - from.translation;
  motion.tail<3>() = cosine > kLeastCosine
                         ? Eigen::Vector3d(2 / cosine * sine)
                         : Eigen::Vector3d(kLongestTurn * half_turn_axis(turn, sine));
  return motion;
}

}  // namespace ist
