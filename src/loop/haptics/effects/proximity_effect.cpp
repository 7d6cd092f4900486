#include "loop/haptics/effects/proximity_effect.h"

#include "loop/haptics/effects/damping_effect.h"

namespace ist {

void ProximityEffect::respond(const EffectInput& input, const Vector6& motion,
                              Response& response) const noexcept {
  brake(input.proximity, settings_.damping, input.dt, motion, response);
}

}  // namespace ist
