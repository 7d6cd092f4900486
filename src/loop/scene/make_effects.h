#pragma once

#include <memory>
#include <vector>

#include "ist/scene.h"

namespace ist {

/// The pose of a body's frame at its place in the scene: of the first held body, that of the tool.
/// The frame has the mesh's axes, and the centre of the grid for its origin.
struct BodyHome {
  Placement pose;          ///< SI
  Eigen::Vector3d origin;  ///< the frame's origin in mesh coordinates, mesh units

  /// The home pose after a motion of the scene: a turn about the frame's origin, then a
  /// translation.
  [[nodiscard]] Placement moved(const Placement& motion) const noexcept {
    return {motion.rotation * pose.rotation, pose.translation + motion.translation};
  }
};

/// Makes the effects of a scene, in the order of Scene's members. Without `contacts`, effects that
/// act at contacts or by proximity are left out. `contact` and `friction` are no effects: the
/// simulation itself keeps the bodies apart.
[[nodiscard]] std::vector<std::unique_ptr<Effect>> make_effects(const Scene& scene,
                                                                const BodyHome& home,
                                                                bool contacts);

/// The union of the effects' needs.
[[nodiscard]] EffectNeeds needs_of(const std::vector<std::unique_ptr<Effect>>& effects) noexcept;

}  // namespace ist
