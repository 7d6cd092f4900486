#include "loop/haptics/devices/plan.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/pose.h"
#include "ist/base/throw_error.h"

namespace ist {

std::string waypoint_flaw(const Waypoint* before, const Waypoint& waypoint) {
  const double time = waypoint.time;
  if (before == nullptr && time != 0) {
    return fmt::format("the first time is {} s: let the plan start at 0", time);
  }
  if (!std::isfinite(time)) return fmt::format("the time is {} s: give a finite one", time);
  if (before != nullptr && !(time > before->time)) {
    return fmt::format("the time {} s does not come after {} s: let times ascend", time,
                       before->time);
  }
  if (!Placement::from(waypoint.pose.isometry())) {
    return fmt::format("the pose is no rigid motion: {}", why_not_rigid(waypoint.pose.isometry()));
  }
  // The trace is 1 + 2 cos(turn), as good as its entries.
  constexpr double kRounding = 1e-4;
  if (before != nullptr &&
      (waypoint.pose.rotation * before->pose.rotation.transpose()).trace() < -kRounding) {
    return "the turn from the waypoint before is more than a third of a circle: add a waypoint "
           "between them, so that its sense is clear";
  }
  return {};
}

Plan::Plan(std::vector<Waypoint> waypoints) : waypoints_(std::move(waypoints)) {
  const ScopedFloatEnvironment environment;
  if (waypoints_.empty()) {
    throw Error(ErrorCode::kArgumentInvalid,
                "the plan has no waypoint: give at least one, at time 0");
  }
  const Waypoint* before = nullptr;
  for (Waypoint& waypoint : waypoints_) {
    const std::string flaw = waypoint_flaw(before, waypoint);
    if (!flaw.empty()) {
      throw_error(ErrorCode::kArgumentInvalid, "plan: waypoint {} (from 0): {}",
                  &waypoint - &waypoints_[0], flaw);
    }
    waypoint.pose = *Placement::from(waypoint.pose.isometry());
    if (before != nullptr) {
      const Vector6 motion = motion_between(before->pose, waypoint.pose);
      legs_.push_back({motion, 1 / std::sqrt(1 + 0.25 * motion.tail<3>().squaredNorm())});
    }
    before = &waypoint;
  }
}

PlanPoint Plan::at(double time) noexcept {
  while (now_ > 0 && time < waypoints_[now_].time) --now_;
  while (now_ < legs_.size() && time >= waypoints_[now_ + 1].time) ++now_;
  const Waypoint& from = waypoints_[now_];
  if (now_ == legs_.size()) return {from.pose, Vector6::Zero()};

  const Leg& leg = legs_[now_];
  const double duration = waypoints_[now_ + 1].time - from.time;
  const double part = (time - from.time) / duration;
  const double c = leg.half_cosine;
  // The quaternion is (1 - part) (1, 0) + part (c, c motion/2); its square gives the speed.
  const double square = 1 - 2 * part * (1 - part) * (1 - c);
  Vector6 motion, velocity;
  motion << part * leg.motion.head<3>(), part * c / (1 - part + part * c) * leg.motion.tail<3>();
  velocity << leg.motion.head<3>() / duration, c / (square * duration) * leg.motion.tail<3>();
  return {from.pose.moved(motion), velocity};
}

}  // namespace ist
