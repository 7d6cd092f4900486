#pragma once

#include <memory>

#include "ist/base/progress.h"
#include "ist/haptics/effects/effect.h"
#include "ist/scene/scene.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

class BuildNotes;
struct LoadedBody;

/// What the effects of a scene search.
struct SceneTrees {
  std::unique_ptr<const SphereTree> fixed, held;  ///< null where nothing needs contacts
  /// The proximity voxels of the fixed body, and the held body in voxels as large; null where
  /// nothing needs them.
  std::unique_ptr<const SphereTree> near_fixed, near_held;
};

/// Takes the trees that bodies have, and builds what else is needed.
/// @param max_memory bytes, for each of them
/// Throws kInputInvalid by the scene's file and line: voxels too small for the mesh or for memory,
/// spheres that a tree file does not have, no triangles for proximity.
[[nodiscard]] SceneTrees build_scene_trees(const Scene& scene, LoadedBody& fixed, LoadedBody& held,
                                           const EffectNeeds& needs, std::uint64_t max_memory,
                                           BuildNotes& notes, Progress* progress);

}  // namespace ist
