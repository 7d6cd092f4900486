#pragma once

#include "ist/haptics/effects/effect.h"

namespace ist {

/// Adds to `response` a one-sided damper at each point of `contacts`:
///
///     f = damping · stiffness_fraction · max(0, -n · u / dt) · n
///
/// with the displacement u of the point from the fixed body, by `motion` in `dt` seconds. A point
/// that recedes or slides has no force. The force is 0 without motion. The fraction is 0 when
/// a point appears or vanishes, so the wrench is continuous. Precondition: dt > 0. Cost: some 150
/// flops a point.
inline void brake(const ToolContacts& contacts, double damping, double dt, const Vector6& motion,
                  Response& response) noexcept {
  for (const ContactPair& pair : contacts.pairs()) {
    const Vector6 relative = motion - pair.drift;
    for (const ToolContact& point : contacts.points(pair)) {
      const double approach = -point.normal.dot(point.moved(relative));
      if (!(approach > 0)) continue;
      const double slope = damping * point.stiffness_fraction / dt;
      response.add(point.arm, slope * approach * point.normal,
                   slope * (point.normal * point.normal.transpose()));
    }
  }
}

/// Takes energy from surfaces in contact as they approach; they do not stick as they part:
///
///     f = b · stiffness_fraction · max(0, -n · u / dt) · n
///
/// with the damping b of a whole contact and the displacement u of the point in a tick of dt
/// seconds (brake). The force does not grow with the depth, since such a damper would be weakest at
/// the impact. The wrench is continuous, since the fraction is 0 when a contact begins.
///
/// Needs: normals, velocity. Source: the damper of K. H. Hunt and F. R. E. Crossley, Coefficient of
/// restitution interpreted as damping in vibroimpact, ASME J. Applied Mechanics 42(2), 1975, with
/// the stiffness fraction in place of a power of the depth, and one-sided, so that no contact
/// pulls.
class DampingEffect final : public Effect {
 public:
  explicit DampingEffect(const DampingSettings& settings) : settings_(settings) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "damping"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override {
    return {.normals = true, .velocity = true};
  }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override {
    brake(input.contacts, settings_.damping, input.dt, motion, response);
  }

 private:
  DampingSettings settings_;
};

}  // namespace ist
