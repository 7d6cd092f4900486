#pragma once

#include "ist/base/api.h"
#include "ist/haptics/effects/effect.h"

namespace ist {

/// What a scene's table `proximity` says.
struct ProximitySettings {
  double distance;  ///< from the fixed surface within which it brakes, m: two proximity voxels
  double damping;   ///< of one whole leaf pair, N s/m; of all at most 10 times as much
};

/// The tool is slowed before it touches, in the voxels that lie about the fixed surface, so that a
/// quick hand does not arrive with all its speed:
///
///     f = b · share · max(0, -n · u / dt) · n
///
/// at each place of EffectInput::proximity, with u the way it moves in a tick of dt seconds
/// (brake). It only takes energy, and what goes away or along feels nothing.
///
/// Needs: proximity, velocity. Source: the pre-contact braking force of W. A. McNeely, K. D.
/// Puterbaugh and J. J. Troy, Six degree-of-freedom haptic rendering using voxel sampling, SIGGRAPH
/// 1999. The normal is that of the tool's leaf, and as the other side has none a pair counts for
/// half.
class IST_API ProximityEffect final : public Effect {
 public:
  explicit ProximityEffect(const ProximitySettings& settings) : settings_(settings) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "proximity"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override {
    return {.velocity = true, .proximity = true};
  }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override;

 private:
  ProximitySettings settings_;
};

}  // namespace ist
