#pragma once

#include <cstdint>

#include "ist/haptics/simulation.h"

namespace ist {

/// Limits the wrench before it reaches the device, force and torque apart:
///
///     target = gain · limited(wanted, max),  output = last + limited(target - last, slew · dt)
///
/// where `limited` shortens a vector that is too long and keeps its direction. The gain rises
/// linearly from 0 to 1 over soft_start seconds of ticks without fault, at the beginning and after
/// each fault. |output| <= gain · max in every tick, and |output - last| <= slew · dt in every tick
/// without fault, both to within rounding (1e-15 of max). A wanted wrench within both limits, at a
/// gain of 1, passes bit for bit.
///
/// A fault sets the output to zero in one step, whatever the slew limit. A wrench that is not
/// finite is a fault.
class WrenchLimiter {
 public:
  /// Precondition: settings are finite, limits and slews positive, soft_start at least 0.
  explicit WrenchLimiter(const SafetySettings& settings) : settings_(settings) {}

  /// Returns the wrench for the device in a tick of `dt` seconds: N and N m. A fault if `wanted` or
  /// dt is not finite, or dt is not positive.
  [[nodiscard]] Vector6 limit(const Vector6& wanted, double dt) noexcept;
  /// Counts a fault and returns a zero wrench for the device.
  Vector6 fault() noexcept;

  [[nodiscard]] std::uint64_t faults() const noexcept { return faults_; }
  /// The gain of the last tick; 0 before the first.
  [[nodiscard]] double gain() const noexcept { return gain_; }

 private:
  SafetySettings settings_;
  Vector6 last_ = Vector6::Zero();
  double good_ = 0;  // s, since the beginning or the last fault
  double gain_ = 0;
  std::uint64_t faults_ = 0;
};

}  // namespace ist
