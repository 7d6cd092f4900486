#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "ist/base/api.h"
#include "ist/haptics/devices/device.h"
#include "ist/haptics/devices/plan.h"

namespace ist {

/// What a scene says of a simulated operator.
struct HandSettings {
  DeviceMechanics mechanics;
  double mass;                   ///< of device and arm, kg
  double inertia;                ///< kg m², the same about every axis
  double arm_stiffness;          ///< with which the arm follows its plan, N/m
  double arm_damping;            ///< N s/m
  double arm_angular_stiffness;  ///< N m/rad
  double arm_angular_damping;    ///< N m s/rad
  double resolution;             ///< of the encoders, m; 0: exact
  double angular_resolution;     ///< rad; 0: exact
  std::vector<Waypoint> plan;    ///< times ascending from 0, at least one
};

/// A simulated operator: an arm that draws a device along its plan, and gives way to what it feels.
///
///     m dv/dt = k (p - x) + c (dp/dt - v) - b v + f
///
/// with the arm's k and c, the plan p, the device's own damping b, and f the force that was written
/// `delay` ago, held until the next. Rotation likewise about the tool's origin: the arm's spring
/// holds 4k (1 - cos(turn/2)), which is k turn²/2 for small turns, and pulls until half a circle.
///
/// Within a tick it goes by steps of 20 µs at most, at least 16, by the implicit midpoint rule,
/// whose linear equation is solved exactly. So in translation no energy comes from nowhere: what
/// kinetic energy and the spring gain is what the force and the plan give, less what is damped; in
/// rotation to within (h w)²/8 of what the spring gives, at w rad/s and steps of h. An oscillation
/// of w rad/s is slow by the part (h w)²/12: 1e-6 at 30 Hz.
///
/// Source of the rule: E. Hairer, C. Lubich and G. Wanner, Geometric Numerical Integration,
/// Springer 2006. The spring's torque is the energy's discrete gradient, as there.
class IST_API HandDevice final : public Device {
 public:
  static constexpr double kLongestDelay = 0.01;    ///< s
  static constexpr double kShortestTick = 0.0001;  ///< s

  /// At rest where the plan starts. Throws kInputInvalid for settings without sense: mass or
  /// inertia not positive, anything negative or not finite, a delay beyond kLongestDelay, a plan
  /// with flaws.
  explicit HandDevice(HandSettings settings);

  [[nodiscard]] DeviceMechanics mechanics() const noexcept override { return settings_.mechanics; }
  /// The pose as encoders tell it: translation and turn from the start (motion_between), rounded
  /// down to whole steps, each along its axis. A turn is to stay below half a circle.
  [[nodiscard]] std::optional<Placement> read() noexcept override;
  /// Precondition: a finite wrench and dt of at least kShortestTick. Cost: some 700 flops a step.
  void write(const Vector6& wrench, double dt) noexcept override;
  /// Whether the plan's last waypoint is past.
  [[nodiscard]] bool done() const noexcept override { return time_ > plan_.end(); }

  /// What encoders cannot tell: where it is, m; how fast, m/s and rad/s; and since when, s.
  [[nodiscard]] const Placement& pose() const noexcept { return pose_; }
  [[nodiscard]] const Vector6& velocity() const noexcept { return velocity_; }
  [[nodiscard]] double time() const noexcept { return time_; }
  /// Kinetic energy and what the arm's spring holds, J.
  [[nodiscard]] double energy() const noexcept;
  /// What the wrench gave since the start, J: negative where it took more.
  [[nodiscard]] double work() const noexcept { return work_; }
  /// What the device's own damping took since the start, J.
  [[nodiscard]] double damped() const noexcept { return damped_; }

 private:
  // A wrench that was written, and the time from which it is felt.
  struct Written {
    double time = 0;
    Vector6 wrench = Vector6::Zero();
  };
  // As many as are written within the longest delay, with room for rounding.
  static constexpr std::size_t kMostWritten = 128;
  static_assert(kMostWritten * kShortestTick > kLongestDelay + 2 * kShortestTick);

  IST_LOCAL void step(double h) noexcept;

  HandSettings settings_;  // without the plan
  Plan plan_;
  Placement pose_;
  Placement planned_;  // at time_
  Vector6 velocity_ = Vector6::Zero();
  Vector6 felt_ = Vector6::Zero();
  double time_ = 0;
  double work_ = 0;
  double damped_ = 0;
  std::array<Written, kMostWritten> written_;  // a ring: what is not felt yet
  std::size_t first_ = 0, waiting_ = 0;
};

}  // namespace ist
