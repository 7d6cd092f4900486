#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "ist/mesh/mesh.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"

namespace ist::answers {

/// Returns the JSON of a mesh. docs/command.md lists its keys.
[[nodiscard]] nlohmann::ordered_json mesh_json(const std::string& file, const MeshReport& report,
                                               const MeshSource& source, PatientFrame frame);

/// Returns the JSON of a tree. `triangles` is the report of its mesh, if it holds one. The keys of
/// voxels are null without voxels, and `levels` is empty.
[[nodiscard]] nlohmann::ordered_json tree_json(const std::string& file, const SphereTree& tree,
                                               const std::optional<MeshReport>& triangles,
                                               std::span<const LevelStatistics> levels);

}  // namespace ist::answers
