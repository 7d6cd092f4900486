#pragma once

#include "ist/base/api.h"
#include "ist/haptics/effects/effect.h"

namespace ist {

/// What a scene's table `damping` says.
struct DampingSettings {
  double damping;  ///< of one whole leaf pair, N s/m; of any contact at most 10 times as much
};

/// Surfaces that touch lose energy as they press together, and do not stick as they part:
///
///     f = b · share · max(0, -n · u / dt) · n
///
/// with u the way the place moves in a tick of dt seconds (brake). It does not grow with the
/// overlap: a share is 0 where a contact begins, which is all that a continuous wrench needs, and
/// a damper that waits for overlap would be weakest at the impact.
///
/// Needs: normals, velocity. Source: the damper of the contact model of K. H. Hunt and F. R. E.
/// Crossley, Coefficient of restitution interpreted as damping in vibroimpact, ASME J. Applied
/// Mechanics 42(2), 1975, with a contact's share in place of a power of its depth, and one-sided,
/// so that no contact pulls.
class IST_API DampingEffect final : public Effect {
 public:
  explicit DampingEffect(const DampingSettings& settings) : settings_(settings) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "damping"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override {
    return {.normals = true, .velocity = true};
  }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override;

 private:
  DampingSettings settings_;
};

}  // namespace ist
