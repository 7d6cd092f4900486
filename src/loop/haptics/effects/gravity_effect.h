#pragma once

#include "ist/haptics/effects/effect.h"

namespace ist {

/// Applies the weight of the held body at its centre of mass:
///
///     f = m · a,    torque = (R · centre) × f
///
/// with the tool's rotation R after the motion. A uniform force has no stiffness. The stiffness of
/// the torque, m a times the arm, is positive where the centre hangs below the tool's origin and
/// negative where it stands above; it is left out, being small beside a coupling's.
///
/// Needs: nothing. Cost: some 400 flops.
class GravityEffect final : public Effect {
 public:
  explicit GravityEffect(const GravitySettings& settings) : settings_(settings) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "gravity"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override { return {}; }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override {
    const Eigen::Vector3d arm = input.tool.moved(motion).rotation * settings_.centre;
    response.add(arm, settings_.mass * settings_.acceleration, Eigen::Matrix3d::Zero());
  }

 private:
  GravitySettings settings_;
};

}  // namespace ist
