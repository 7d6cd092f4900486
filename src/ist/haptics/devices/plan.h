#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ist/base/api.h"
#include "ist/haptics/placement.h"

namespace ist {

/// Where a plan is at a time.
struct Waypoint {
  double time;  ///< s
  Placement pose;
};

/// Where a plan is between its waypoints, and how fast: m/s and rad/s, axes of the scene.
struct PlanPoint {
  Placement pose;
  Vector6 velocity;
};

/// A motion through waypoints. Between two of them the translation goes at one speed; the turn is
/// that of their quaternions' linear interpolation, normalised, about one axis, the same there and
/// back, at a speed within 4/3 of the mean. After the last waypoint it stays.
///
/// Source of the turn: what animators call nlerp, here by its half angle's tangent, which
/// Placement::moved takes without a sine.
class IST_API Plan {
 public:
  /// Throws kInputInvalid, naming the waypoint, where there is none or one has a flaw
  /// (waypoint_flaw).
  explicit Plan(std::vector<Waypoint> waypoints);

  /// Allocates nothing. Cost: some 300 flops, and a step for each waypoint since the last call.
  /// Precondition: at least 0.
  [[nodiscard]] PlanPoint at(double time) noexcept;

  [[nodiscard]] const Placement& start() const noexcept { return waypoints_.front().pose; }
  /// The last waypoint's time, s.
  [[nodiscard]] double end() const noexcept { return waypoints_.back().time; }

 private:
  // From a waypoint to the next.
  struct Leg {
    Vector6 motion;
    double half_cosine;  // of its turn
  };

  std::vector<Waypoint> waypoints_;
  std::vector<Leg> legs_;
  std::size_t now_ = 0;  // the last waypoint that was passed
};

/// What is wrong with a waypoint and how to mend it, for a sentence; empty where it is sound. Times
/// start at 0 and ascend, poses are rigid motions, and from one to the next they turn by a third of
/// a circle at most. `before` is null for the first.
[[nodiscard]] IST_API std::string waypoint_flaw(const Waypoint* before, const Waypoint& waypoint);

}  // namespace ist
