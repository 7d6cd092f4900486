#pragma once

#include "ist/base/api.h"
#include "ist/haptics/effects/effect.h"

namespace ist {

/// What a scene's table `gravity` says.
struct GravitySettings {
  double mass;                   ///< of the held body, kg
  Eigen::Vector3d centre;        ///< of mass, m, in the tool's frame
  Eigen::Vector3d acceleration;  ///< m/s², axes of the scene
};

/// The weight of the held body, at its centre of mass:
///
///     f = m · a,    torque = (R · centre) × f
///
/// with R the tool's rotation after the motion. A force that is the same everywhere has no
/// stiffness. The torque's, m a times the arm, is positive where the centre hangs below the tool's
/// origin and negative where it stands above; it is left out, being small beside a coupling's.
///
/// Needs: nothing. Source: Newton. Cost: some 400 flops.
class IST_API GravityEffect final : public Effect {
 public:
  explicit GravityEffect(const GravitySettings& settings) : settings_(settings) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "gravity"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override { return {}; }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override;

 private:
  GravitySettings settings_;
};

}  // namespace ist
