#pragma once

#include "ist/haptics/effects/effect.h"

namespace ist {

/// Pushes surfaces apart by a spring at each tangent plane:
///
///     f = k · stiffness_fraction · max(0, depth - n · u) · n
///
/// with the stiffness k of a whole contact (SpringsSettings) and the displacement u of the point
/// from the fixed body. At the pose of the query the wrench is the sum over all leaf pairs, none
/// merged (ToolContacts::spring); the points give its change.
///
/// Within a tick the change is extrapolated to kLead times the motion. A contact that deepens gains
/// pairs and weight, until it has the full area. Meanwhile the sum grows 1.5 times as steeply as
/// its springs on a flat face, and 4 times on a ball of two voxels. A force that lags behind its
/// depth returns more energy than it took, and makes a coupling active within its border. A force
/// that leads only damps. At rest nothing is extrapolated.
///
/// Needs: normals, depth. Source: tangent-plane force model and averaging of many contacts, W. A.
/// McNeely, K. D. Puterbaugh and J. J. Troy, Six degree-of-freedom haptic rendering using voxel
/// sampling, SIGGRAPH 1999, sections 4.1 and 4.4.
class SpringsEffect final : public Effect {
 public:
  static constexpr double kLead = 4;

  explicit SpringsEffect(const SpringsSettings& settings) : settings_(settings) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "springs"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override {
    return {.normals = true, .depth = true};
  }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override;

  /// The normal force at a point after a motion from its fixed body, N.
  [[nodiscard]] double force(const ToolContact& point, const Vector6& motion) const noexcept;

 private:
  SpringsSettings settings_;
};

}  // namespace ist
