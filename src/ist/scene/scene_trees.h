#pragma once

#include "ist/scene.h"

namespace ist {

class BuildNotes;
struct LoadedBody;

/// Builds the trees that effects need, or takes them from the bodies.
/// @param max_memory bytes, for each tree
/// Throws kInputInvalid (fail_at): voxels too small for the mesh or the memory, a tree file without
/// the required spheres or triangles, a fixed body without outside.
[[nodiscard]] SceneTrees build_scene_trees(const Scene& scene, LoadedBody& fixed, LoadedBody& held,
                                           const EffectNeeds& needs, std::uint64_t max_memory,
                                           BuildNotes& notes, Progress* progress);

}  // namespace ist
