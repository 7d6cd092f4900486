#pragma once

#include <array>
#include <cstddef>

#include "ist/haptics/devices/device.h"
#include "loop/haptics/devices/plan.h"

namespace ist {

/// A simulated operator: an arm that moves a device along a plan and yields to the wrench.
///
///     m dv/dt = k (p - x) + c (dp/dt - v) - b v + f
///
/// with the arm's stiffness k and damping c, the plan p, the device's damping b, and the force f
/// that was written `delay` ago, held until the next one. Rotation follows the same law about the
/// tool's origin: the arm's spring stores 4k (1 - cos(turn/2)), which is k turn²/2 for small turns.
///
/// A tick is integrated by the implicit midpoint rule in at least 16 steps of at most 20 µs. In
/// translation the energy balance is exact: kinetic energy and spring gain the work of force and
/// plan less the damping. In rotation it is exact to (h w)²/8 of the spring's energy, for w rad/s
/// and steps of h. An oscillation of w rad/s is slow by (h w)²/12: 1e-6 at 30 Hz.
///
/// Source: E. Hairer, C. Lubich and G. Wanner, Geometric Numerical Integration, Springer 2006: the
/// midpoint rule, and the spring's torque as the energy's discrete gradient.
class HandDevice final : public Device {
 public:
  static constexpr double kLongestDelay = 0.01;                       ///< s
  static constexpr double kShortestTick = 0.0001, kLongestTick = 10;  ///< s

  /// Rests at the start of the plan. Throws as make_hand_device() does.
  explicit HandDevice(HandSettings settings);

  [[nodiscard]] DeviceMechanics mechanics() const noexcept override { return settings_.mechanics; }
  /// Reads the encoders: translation and turn from the start (motion_between), each axis rounded
  /// down to whole steps. The turn must stay below half a circle.
  [[nodiscard]] std::optional<Placement> read() noexcept override;
  /// Integrates one tick. Ignores a wrench that is not finite and a `dt` outside [kShortestTick,
  /// kLongestTick]. Cost: some 700 flops a step.
  void write(const Vector6& wrench, double dt) noexcept override;
  /// Whether the time of the last waypoint has passed.
  [[nodiscard]] bool done() const noexcept override { return time_ > plan_.end(); }

  /// The exact state, without encoders: m; m/s and rad/s; s.
  [[nodiscard]] const Placement& pose() const noexcept { return pose_; }
  [[nodiscard]] const Vector6& velocity() const noexcept { return velocity_; }
  [[nodiscard]] double time() const noexcept { return time_; }
  /// Kinetic energy and the energy of the arm's spring, J.
  [[nodiscard]] double energy() const noexcept;
  /// The work of the wrench on the hand since the start, J.
  [[nodiscard]] double work() const noexcept { return work_; }
  /// The energy dissipated by the device's damping since the start, J.
  [[nodiscard]] double damped() const noexcept { return damped_; }

 private:
  // A wrench, and the time at which the hand begins to feel it.
  struct Written {
    double time = 0;
    Vector6 wrench = Vector6::Zero();
  };
  // The most wrenches within the longest delay, with room for rounding.
  static constexpr std::size_t kMostWritten = 128;
  static_assert(kMostWritten * kShortestTick > kLongestDelay + 2 * kShortestTick);

  void step(double h) noexcept;

  HandSettings settings_;  // without the plan
  Plan plan_;
  Placement pose_;
  Placement planned_;  // at time_
  Vector6 velocity_ = Vector6::Zero();
  Vector6 felt_ = Vector6::Zero();
  double time_ = 0;
  double work_ = 0;
  double damped_ = 0;
  std::array<Written, kMostWritten> written_;  // a ring of the wrenches that are not felt yet
  std::size_t first_ = 0, waiting_ = 0;
};

}  // namespace ist
