#include "loop/haptics/effects/gravity_effect.h"

namespace ist {

void GravityEffect::respond(const EffectInput& input, const Vector6& motion,
                            Response& response) const noexcept {
  const Eigen::Vector3d arm = input.tool.moved(motion).rotation * settings_.centre;
  response.add(arm, settings_.mass * settings_.acceleration, Eigen::Matrix3d::Zero());
}

}  // namespace ist
