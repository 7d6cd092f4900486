#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ist/constraint/nearest_motion.h"
#include "ist/haptics/effects/effect.h"
#include "ist/haptics/simulation.h"
#include "ist/tree/sphere_tree.h"
#include "loop/haptics/coupling.h"

namespace ist {

/// The effects of a simulation, each with the time spent in it.
class TimedEffects {
 public:
  TimedEffects() = default;
  explicit TimedEffects(std::vector<std::unique_ptr<Effect>> effects);

  /// Adds the response of every effect, and `calls` times its time.
  void respond(const EffectInput& input, const Vector6& motion, Response& response,
               int calls) noexcept;
  /// Adds the response of every effect without a look at the clock.
  void respond(const EffectInput& input, const Vector6& motion, Response& response) const noexcept;
  void advance(const EffectInput& input, const Vector6& motion) noexcept;
  void reset() noexcept;

  [[nodiscard]] std::span<const EffectTime> times() const noexcept { return times_; }

 private:
  std::vector<std::unique_ptr<Effect>> effects_;
  std::vector<EffectTime> times_;
};

/// Finds the tool's motion of a tick. The tool has no mass: it moves to the balance of coupling and
/// effects by a few Newton steps on the contacts at its present pose; the next ticks, which know
/// the contacts at its new pose, finish the motion.
///
/// Quasi-static virtual coupling: M. A. Otaduy and M. C. Lin, A modular haptic rendering algorithm
/// for stable and transparent 6-DOF manipulation, IEEE Trans. Robotics 22(4), 2006, and M. Wan and
/// W. A. McNeely, Quasi-static approximation for 6 degrees-of-freedom haptic rendering, IEEE
/// Visualization 2003.
class Tool {
 public:
  static constexpr int kNewtonSteps = 3;
  /// No step limit, for a tool without contacts, which cannot tunnel.
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  /// @param radius   bound on the distance of the held surface from the tool's origin, m
  /// @param max_step bound on the displacement of the held surface in a tick, m: one voxel, so that
  ///                 nothing tunnels
  Tool(double radius, double max_step) : radius_(radius), max_step_(max_step) {}

  /// Finds the motion; empty if it is not finite. `scale` is the allowed fraction of max_step().
  /// Cost: 1 µs, and a few ns for each contact point, effect and Newton step.
  [[nodiscard]] std::optional<Vector6> motion(const EffectInput& input, TimedEffects& effects,
                                              const VirtualCoupling& coupling,
                                              const VirtualCoupling::Stretch& stretch,
                                              double scale = 1) const noexcept;
  /// Finds the motion that obeys bounds, of any length; 0 if no motion obeys them. Without bounds
  /// the same with none.
  /// @param tolerance a bound may be violated by so much, m
  [[nodiscard]] std::optional<Vector6> motion(const EffectInput& input, TimedEffects& effects,
                                              const VirtualCoupling& coupling,
                                              const VirtualCoupling::Stretch& stretch,
                                              NearestMotion* bounds,
                                              double tolerance) const noexcept;

  /// A bound on the displacement of the tool's surface, m.
  [[nodiscard]] double way(const Vector6& motion) const noexcept;

  [[nodiscard]] double max_step() const noexcept { return max_step_; }
  [[nodiscard]] double radius() const noexcept { return radius_; }
  /// Says how far the held surface reaches from now on.
  void set_radius(double radius) noexcept { radius_ = radius; }

 private:
  double radius_, max_step_;
};

/// Bounds the distance of the body's surface from the origin of its tree's frame, mesh units: at
/// most two voxel diagonals above the true maximum. Cost: 1 ns a node above the leaves.
[[nodiscard]] double surface_radius(const SphereTree& tree) noexcept;

}  // namespace ist
