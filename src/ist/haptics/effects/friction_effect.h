#pragma once

#include <optional>

#include "ist/base/api.h"
#include "ist/haptics/effects/contact_effect.h"

namespace ist {

/// What a scene's table `friction` says.
struct FrictionSettings {
  double static_coefficient;   ///< µ_s: no sliding starts below this part of the normal force
  double dynamic_coefficient;  ///< µ_d <= µ_s: what is left of it while it slides
  double stiffness;            ///< across the normal, before it slides, of one whole leaf pair, N/m
};

/// Surfaces that are pressed together stick, then slide. The tool's proxy is the pose at which it
/// stuck, the anchor; a point of the tool is stretched, across its normal n, by its way from where
/// the anchor has it to where it is:
///
///     t = (I - n nᵀ) (place now - place under the anchor),    f = -c · k · share · t
///     c = min(1, µ · Σ f_n / Σ k · share · |t|)
///
/// with f_n the normal forces of `contact`, and the sums over all points: one limit for the whole
/// contact, so that points which lie apart also hold against a turn. µ is µ_s while it sticks and
/// µ_d while it slides.
///
/// At the end of a tick whose stretches pull more than the limit it slides: the anchor is drawn
/// after the tool until they pull µ_d Σ f_n. It sticks again in the first tick that ends with no
/// more than that, and while it sticks the anchor's numbers do not change: it cannot drift. Without
/// normal force there is no anchor; the first tick with one begins at that tick's first pose.
///
/// Within a tick a place moves by TouchPoint::moved; the anchor follows where it has truly come to.
/// A stretch that the anchor keeps in sliding is right to within a part of it, the square of the
/// turn, in radians, between the anchor and the tool. Where shares and normals stay it never gives
/// back more than it took; a share that grows while it is stretched brings its part of the spring's
/// energy.
///
/// The stiffness is the secant's, c · k · share across the normals: that of sticking while it
/// sticks, more than that of sliding along the way of it.
///
/// Needs: normals, depth; no velocity, as the law is one of places. Sources: V. Hayward and B.
/// Armstrong, A new computational model of friction applied to haptic rendering, Experimental
/// Robotics VI, Springer 2000 (the anchor, which does not drift); D. Karnopp, Computer simulation
/// of stick-slip friction in mechanical dynamic systems, ASME J. Dynamic Systems, Measurement and
/// Control 107(1), 1985 (rest is a band about no motion). Cost: some 250 flops a
/// point.
class IST_API FrictionEffect final : public Effect {
 public:
  /// `contact` must outlive it.
  FrictionEffect(const FrictionSettings& settings, const ContactEffect& contact)
      : settings_(settings), contact_(contact) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "friction"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override {
    return {.normals = true, .depth = true};
  }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override;
  void advance(const EffectInput& input, const Vector6& motion) noexcept override;
  void reset() noexcept override;

  /// Where the tool stuck; nothing where nothing presses.
  [[nodiscard]] const std::optional<Placement>& anchor() const noexcept { return anchor_; }
  /// Whether the last tick ended in sliding.
  [[nodiscard]] bool slides() const noexcept { return sliding_; }

 private:
  // The most that the contact holds, N.
  [[nodiscard]] IST_LOCAL double limit(double normal_force) const noexcept;
  [[nodiscard]] IST_LOCAL double normal_force(const TouchSet& contacts,
                                              const Vector6& motion) const noexcept;

  FrictionSettings settings_;
  const ContactEffect& contact_;
  std::optional<Placement> anchor_;
  bool sliding_ = false;
};

}  // namespace ist
