#pragma once

#include <optional>
#include <span>
#include <vector>

#include "loop/haptics/effects/contact_effect.h"

namespace ist {

/// Makes surfaces in contact stick, then slide. The anchor is the pose at which the tool stuck. A
/// contact point is stretched, across its normal n, from its position under the anchor to its
/// position now:
///
///     t = (I - n nᵀ) (position now - position under the anchor)
///     f = -c · k · stiffness_fraction · t,    c = min(1, µ · Σ f_n / Σ k · stiffness_fraction ·
///     |t|)
///
/// with the normal forces f_n of `contact` and sums over all points: one limit for the whole
/// contact, so that distant points also resist a turn. µ is µ_s while it sticks, µ_d while it
/// slides.
///
/// A tick slides if its stretches at the end exceed the limit: the anchor then follows the tool
/// until they pull with µ_d Σ f_n. Otherwise it sticks and the anchor keeps its bits, so it cannot
/// drift. Without normal force there is no anchor; the first tick with one sets it to the pose at
/// its beginning.
///
/// Each pair of bodies sticks and slides by itself. Where the fixed body moves, the anchor moves
/// with it.
///
/// Within a tick a point moves by ToolContact::moved; the anchor follows its exact position. After
/// sliding, a stretch is exact up to a fraction of it, the square of the turn in radians between
/// anchor and tool. With constant fractions and normals no energy is returned beyond the energy
/// taken; a fraction that grows under stretch adds its part of the spring's energy. The stiffness
/// is the secant's, c · k · stiffness_fraction across the normal.
///
/// Needs: normals, depth. Sources: V. Hayward and B. Armstrong, A new computational model of
/// friction applied to haptic rendering, Experimental Robotics VI, Springer 2000 (the anchor that
/// does not drift); D. Karnopp, Computer simulation of stick-slip friction in mechanical dynamic
/// systems, ASME J. Dynamic Systems, Measurement and Control 107(1), 1985 (rest is a band about no
/// motion). Cost: some 250 flops a point.
class FrictionEffect final : public Effect {
 public:
  /// `contact` must outlive the effect; `pairs` are the pairs of bodies.
  FrictionEffect(const FrictionSettings& settings, const ContactEffect& contact,
                 std::size_t pairs = 1)
      : settings_(settings), contact_(contact), grips_(pairs) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "friction"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override {
    return {.normals = true, .depth = true};
  }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override;
  void advance(const EffectInput& input, const Vector6& motion) noexcept override;
  void reset() noexcept override;

  /// The pose at which the tool stuck to the fixed body of a pair; empty without normal force.
  [[nodiscard]] const std::optional<Placement>& anchor(std::size_t pair = 0) const noexcept {
    return grips_[pair].anchor;
  }
  /// Whether the last tick slid.
  [[nodiscard]] bool slides(std::size_t pair = 0) const noexcept { return grips_[pair].sliding; }

 private:
  // Of a pair of bodies.
  struct Grip {
    std::optional<Placement> anchor = {};
    bool sliding = false;
    void lose() noexcept {
      anchor.reset();
      sliding = false;
    }
  };

  // The largest tangential force, N.
  [[nodiscard]] double limit(const Grip& grip, double normal_force) const noexcept;
  [[nodiscard]] double normal_force(std::span<const ToolContact> points,
                                    const Vector6& relative) const noexcept;
  void advance(Grip& grip, const EffectInput& input, const ContactPair& pair,
               const Vector6& motion) const noexcept;

  FrictionSettings settings_;
  const ContactEffect& contact_;
  std::vector<Grip> grips_;  // by the pairs' numbers
};

}  // namespace ist
