#include "loop/haptics/effects/damping_effect.h"

namespace ist {

void DampingEffect::respond(const EffectInput& input, const Vector6& motion,
                            Response& response) const noexcept {
  brake(input.contacts, settings_.damping, input.dt, motion, response);
}

}  // namespace ist
