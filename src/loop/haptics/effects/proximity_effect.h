#pragma once

#include "ist/haptics/effects/effect.h"
#include "loop/haptics/effects/damping_effect.h"

namespace ist {

/// Slows the tool in the proximity voxels about the fixed surface, before the surfaces meet:
///
///     f = kFullPairs · b · stiffness_fraction · max(0, -n · u / dt) · n
///
/// at each point of EffectInput::proximity, with its displacement u in a tick of dt seconds
/// (brake). A leaf pair has the damping b, and all pairs together at most kFullPairs times as much:
/// the fractions of a contact add up to 1. The effect only takes energy; a tool that recedes or
/// slides feels no force.
///
/// Needs: proximity, velocity. Source: the pre-contact braking force of W. A. McNeely, K. D.
/// Puterbaugh and J. J. Troy, Six degree-of-freedom haptic rendering using voxel sampling, SIGGRAPH
/// 1999. Proximity voxels have no normals. A pair takes the normal of the tool's leaf, and counts
/// for half.
class ProximityEffect final : public Effect {
 public:
  /// A contact has its whole damping from so many whole leaf pairs on.
  static constexpr double kFullPairs = 10;

  explicit ProximityEffect(const ProximitySettings& settings) : settings_(settings) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "proximity"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override {
    return {.velocity = true, .proximity = true};
  }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override {
    brake(input.proximity, kFullPairs * settings_.damping, input.dt, motion, response);
  }

 private:
  ProximitySettings settings_;
};

}  // namespace ist
