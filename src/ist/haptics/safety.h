#pragma once

#include <cstdint>

#include "ist/base/api.h"
#include "ist/haptics/placement.h"

namespace ist {

/// What a scene's table `safety` says. Always on.
struct SafetySettings {
  double max_force;    ///< N
  double max_torque;   ///< N m
  double force_slew;   ///< N/s
  double torque_slew;  ///< N m/s
  double soft_start;   ///< s, from no force to all of it, at the beginning and after a fault
};

/// The last that a wrench goes through before the device. Force and torque apart:
///
///     target = gain · limited(wanted, max),  output = last + limited(target - last, slew · dt)
///
/// where `limited` scales a vector that is too long and keeps its direction. The gain goes from 0
/// to 1, linearly over soft_start seconds of good ticks, at the beginning and after each fault. So
/// |output| <= gain · max in every tick, and |output - last| <= slew · dt in every tick that is no
/// fault, both to within rounding (1e-15 of max). A wanted wrench that breaks neither, at a gain of
/// 1, passes bit for bit.
///
/// A fault is not held up by the slew limit: its output is zero at once, in one step. What is not
/// finite cannot be limited, so it is a fault.
class IST_API WrenchGuard {
 public:
  /// Precondition: settings are finite, limits and slews positive, soft_start at least 0.
  explicit WrenchGuard(const SafetySettings& settings) : settings_(settings) {}

  /// What the device is told in a tick of `dt` seconds: N and N m. A fault where anything of
  /// `wanted` or dt is not finite, or dt not positive.
  [[nodiscard]] Vector6 pass(const Vector6& wanted, double dt) noexcept;
  /// What it is told instead in a tick in which something else went wrong: zero.
  Vector6 fault() noexcept;

  [[nodiscard]] std::uint64_t faults() const noexcept { return faults_; }
  /// Of the last tick; 0 before the first.
  [[nodiscard]] double gain() const noexcept { return gain_; }

 private:
  SafetySettings settings_;
  Vector6 last_ = Vector6::Zero();
  double good_ = 0;  // s, since the beginning or the last fault
  double gain_ = 0;
  std::uint64_t faults_ = 0;
};

}  // namespace ist
