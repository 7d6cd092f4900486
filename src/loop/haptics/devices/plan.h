#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ist/haptics/devices/device.h"

namespace ist {

/// A pose and a velocity of a plan: m/s and rad/s, scene axes.
struct PlanPoint {
  Placement pose;
  Vector6 velocity;
};

/// A motion through waypoints. Between two waypoints the translation has a constant speed; the
/// rotation interpolates the quaternions linearly and normalises them (nlerp): it turns about one
/// axis, with a speed of at most 4/3 of the mean. After the last waypoint the plan rests.
class Plan {
 public:
  /// Throws kArgumentInvalid, naming the waypoint, if there is no waypoint or one has a flaw
  /// (waypoint_flaw).
  explicit Plan(std::vector<Waypoint> waypoints);

  /// Interpolates the plan. Allocates nothing. Cost: some 300 flops, and a step for each waypoint
  /// since the last call. Precondition: `time` is at least 0.
  [[nodiscard]] PlanPoint at(double time) noexcept;

  [[nodiscard]] const Placement& start() const noexcept { return waypoints_.front().pose; }
  /// The time of the last waypoint, s.
  [[nodiscard]] double end() const noexcept { return waypoints_.back().time; }

 private:
  // The motion from one waypoint to the next.
  struct Leg {
    Vector6 motion;
    double half_cosine;  // cosine of half the turn
  };

  std::vector<Waypoint> waypoints_;
  std::vector<Leg> legs_;
  std::size_t now_ = 0;  // the last waypoint that was passed
};

/// Describes the flaw of a waypoint and its remedy, as the end of a sentence; empty if there is
/// none. Times ascend from 0, poses are rigid motions, and from one to the next they turn by a
/// third of a circle at most. `before` is null for the first waypoint.
[[nodiscard]] std::string waypoint_flaw(const Waypoint* before, const Waypoint& waypoint);

}  // namespace ist
