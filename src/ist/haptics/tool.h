#pragma once

#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "ist/base/api.h"
#include "ist/haptics/coupling.h"
#include "ist/haptics/effects/effect.h"

namespace ist {

/// The tool's motion of a tick: without mass, it goes where the coupling and all effects are in
/// balance. A few Newton steps on what is known at its present pose; what they leave undone the
/// next ticks do, for these know the contacts there.
///
/// Quasi-static virtual coupling: M. A. Otaduy and M. C. Lin, A modular haptic rendering algorithm
/// for stable and transparent 6-DOF manipulation, IEEE Trans. Robotics 22(4), 2006, and M. Wan and
/// W. A. McNeely, Quasi-static approximation for 6 degrees-of-freedom haptic rendering, IEEE
/// Visualization 2003.
class IST_API Tool {
 public:
  static constexpr int kNewtonSteps = 3;

  /// @param radius    no point of the held surface is farther from the tool's origin, m
  /// @param max_step  no point of it moves farther in a tick, m: a voxel, so that nothing tunnels
  Tool(double radius, double max_step) : radius_(radius), max_step_(max_step) {}

  /// A longest step that is none: where nothing is touched, nothing tunnels.
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  /// An effect, and what it has taken so far.
  struct TimedEffect {
    std::unique_ptr<Effect> effect;
    std::chrono::nanoseconds time{};

    void advance(const EffectInput& input, const Vector6& motion) noexcept;
  };

  /// The motion, or nothing where there is no finite one. `part` of the longest step is allowed.
  /// Cost: 1 µs, and a few ns for each contact point, effect and Newton step.
  [[nodiscard]] std::optional<Vector6> motion(const EffectInput& input,
                                              std::span<TimedEffect> effects,
                                              const VirtualCoupling& coupling,
                                              const VirtualCoupling::Stretch& stretch,
                                              double part = 1) const noexcept;

  /// How far a point of the tool's surface goes at most, m.
  [[nodiscard]] double way(const Vector6& motion) const noexcept;

  [[nodiscard]] double max_step() const noexcept { return max_step_; }

 private:
  double radius_, max_step_;
};

}  // namespace ist
