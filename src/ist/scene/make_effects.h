#pragma once

#include <memory>
#include <vector>

#include "ist/haptics/effects/effect.h"
#include "ist/scene/scene.h"

namespace ist {

/// Where the tool is when the held body is where the scene puts it.
struct ToolHome {
  Placement pose;          ///< SI
  Eigen::Vector3d origin;  ///< of the tool in the held mesh, mesh units

  /// After a motion as a scene gives it: a turn about the tool's origin, then a translation.
  [[nodiscard]] Placement moved(const Placement& motion) const noexcept {
    return {motion.rotation * pose.rotation, pose.translation + motion.translation};
  }
};

/// The effects that a scene names, in the order of Scene's members; without `contacts` none that
/// pushes where bodies meet.
[[nodiscard]] std::vector<std::unique_ptr<Effect>> make_effects(const Scene& scene,
                                                                const ToolHome& home,
                                                                bool contacts);

/// The union of what they need.
[[nodiscard]] EffectNeeds needs_of(const std::vector<std::unique_ptr<Effect>>& effects) noexcept;

}  // namespace ist
