#pragma once

#include "ist/base/api.h"
#include "ist/haptics/effects/effect.h"

namespace ist {

/// What a scene's table `snap` says.
struct SnapSettings {
  Placement pose;            ///< of the tool, to which it is drawn
  double stiffness;          ///< N/m
  double angular_stiffness;  ///< N m/rad
  double radius;             ///< m: it draws within this distance,
  double angle;              ///< and this turn, as motion_between counts it: 2 tan(turn/2)
};

/// A magnet at a stored pose, as where a planned occlusion is found. With Δx and Δθ the way there
/// from the tool after its motion (motion_between), s = |Δx|²/radius², t = |Δθ|²/angle²,
/// p(s) = (1 - s)³ and q(s) = (1 - s²)³, both 0 beyond 1, it has the energy
///
///     V = -k radius²/6 · p(s) q(t) - k_θ angle²/6 · q(s) p(t)
///
/// and draws with what V loses on the way:
///
///     f = (k (1 - s)² q(t) + 2 k_θ (angle/radius)² s (1 - s²)² p(t)) · Δx
///     τ = (k_θ (1 - t)² q(s) + 2 k (radius/angle)² t (1 - t²)² p(s)) (1 + |Δθ|²/4) · Δθ
///
/// Near the pose these are springs of stiffness k and k_θ; to the edge they fall to 0 and so does
/// their slope. No closed path gains energy, which one window on both, in f = k φ(s + t) Δx and
/// τ = k_θ φ(s + t) Δθ, would give wherever k radius² is not k_θ angle². The last factor of τ is
/// there because |Δθ| is twice the tangent of half the angle, and grows that much faster.
///
/// The stiffness given is the secant's: f over Δx and τ over Δθ, a diagonal that is never negative.
///
/// Needs: nothing. Source: a virtual fixture that attracts, as in L. B. Rosenberg, Virtual
/// fixtures: perceptual tools for telerobotic manipulation, IEEE VRAIS 1993; the window is own.
/// Cost: some 400 flops.
class IST_API SnapEffect final : public Effect {
 public:
  /// Precondition: the stiffnesses are at least 0, radius and angle are positive, and the angle is
  /// less than half a circle.
  explicit SnapEffect(const SnapSettings& settings) : settings_(settings) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "snap"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override { return {}; }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override;

 private:
  SnapSettings settings_;
};

}  // namespace ist
