#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "ist/mesh/mesh.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"

namespace ist::cli {

/// Returns what `ist info --json` says of a mesh: the keys stand in docs/command.md.
[[nodiscard]] nlohmann::ordered_json mesh_json(const std::string& file, const MeshReport& report,
                                               const MeshSource& source, PatientFrame frame);

/// Returns what it says of a tree. `triangles`: the report of its mesh, if it holds one.
[[nodiscard]] nlohmann::ordered_json tree_json(const std::string& file, const SphereTree& tree,
                                               const std::optional<MeshReport>& triangles,
                                               std::span<const LevelStatistics> levels);

}  // namespace ist::cli
