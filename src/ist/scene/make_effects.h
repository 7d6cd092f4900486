#pragma once

#include <memory>
#include <vector>

#include "ist/scene.h"

namespace ist {

/// The pose of the tool at the held body's place in the scene.
struct ToolHome {
  Placement pose;          ///< SI
  Eigen::Vector3d origin;  ///< the tool's origin in held mesh coordinates, mesh units

  /// The home pose after a motion of the scene: a turn about the tool's origin, then a translation.
  [[nodiscard]] Placement moved(const Placement& motion) const noexcept {
    return {motion.rotation * pose.rotation, pose.translation + motion.translation};
  }
};

/// Makes the effects of a scene, in the order of Scene's members. Without `contacts`, effects that
/// act at contacts or by proximity are left out.
[[nodiscard]] std::vector<std::unique_ptr<Effect>> make_effects(const Scene& scene,
                                                                const ToolHome& home,
                                                                bool contacts);

/// The union of the effects' needs.
[[nodiscard]] EffectNeeds needs_of(const std::vector<std::unique_ptr<Effect>>& effects) noexcept;

}  // namespace ist
