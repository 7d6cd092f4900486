#pragma once

#include "ist/haptics/effects/effect.h"

namespace ist {

/// Draws the tool to a stored pose, such as a planned occlusion. With the motion Δx, Δθ from the
/// tool to the pose (motion_between), s = |Δx|²/radius², t = |Δθ|²/angle², p(s) = (1 - s)³ and
/// q(s) = (1 - s²)³, both 0 beyond 1, the energy is
///
///     V = -k radius²/6 · p(s) q(t) - k_θ angle²/6 · q(s) p(t)
///
/// and the wrench its negative gradient:
///
///     f = (k (1 - s)² q(t) + 2 k_θ (angle/radius)² s (1 - s²)² p(t)) · Δx
///     τ = (k_θ (1 - t)² q(s) + 2 k (radius/angle)² t (1 - t²)² p(s)) (1 + |Δθ|²/4) · Δθ
///
/// Near the pose these are springs of stiffness k and k_θ; at the edge they and their slopes are 0.
/// No closed path gains energy; one window φ(s + t) on both springs would gain some wherever
/// k radius² differs from k_θ angle². The last factor of τ is there because |Δθ| is twice the
/// tangent of half the angle. The stiffness is the secant's, f over Δx and τ over Δθ: a diagonal
/// that is never negative.
///
/// Needs: nothing. Source: an attracting virtual fixture, as in L. B. Rosenberg, Virtual fixtures:
/// perceptual tools for telerobotic manipulation, IEEE VRAIS 1993; the window is our own. Cost:
/// some 400 flops.
class SnapEffect final : public Effect {
 public:
  /// Precondition: stiffnesses are at least 0; radius and angle are positive, and the angle is less
  /// than half a circle.
  explicit SnapEffect(const SnapSettings& settings) : settings_(settings) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "snap"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override { return {}; }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override;

 private:
  SnapSettings settings_;
};

}  // namespace ist
