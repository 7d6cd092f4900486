#pragma once

#include "ist/base/api.h"
#include "ist/haptics/effects/effect.h"

namespace ist {

/// What a scene's table `contact` says.
struct ContactSettings {
  double stiffness;  ///< of one whole leaf pair, k, N/m; of any contact at most 10 times as much
  double margin;     ///< how far apart surfaces begin to push, in voxels, from 0 to 0.5
};

/// Surfaces push each other apart, by a spring at each tangent plane:
///
///     f = k · share · max(0, overlap - n · u) · n
///
/// with u the way the place moves. At the pose of the query the wrench is the sum over all leaf
/// pairs (TouchSet::spring), in which nothing is merged; the points tell how it changes.
///
/// Within a tick they tell it for kLead times the motion. A contact that deepens gains pairs and
/// weight, which no share tells: where surfaces first meet, the sum grows 1.5 times as steeply as
/// its springs on a flat face, and 4 times on a ball of two voxels. A force that comes behind its
/// depth gives back more than it took, and so would make a coupling active within its border; one
/// that is foreseen too steep holds the tool back for a tick or two, which only damps. At rest
/// nothing is foreseen and all is the same.
///
/// Needs: normals, depth. Source: the tangent-plane force model and the averaging of many contacts
/// of W. A. McNeely, K. D. Puterbaugh and J. J. Troy, Six degree-of-freedom haptic rendering using
/// voxel sampling, SIGGRAPH 1999, sections 4.1 and 4.4.
class IST_API ContactEffect final : public Effect {
 public:
  static constexpr double kLead = 4;

  explicit ContactEffect(const ContactSettings& settings) : settings_(settings) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "contact"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override {
    return {.normals = true, .depth = true};
  }
  void respond(const EffectInput& input, const Vector6& motion,
               Response& response) const noexcept override;

  /// The force along the normal at a point whose place has gone by `motion`, N.
  [[nodiscard]] double force(const TouchPoint& point, const Vector6& motion) const noexcept;

 private:
  ContactSettings settings_;
};

}  // namespace ist
