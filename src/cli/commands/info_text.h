#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"

namespace ist::cli {

/// Prints for people a mesh's counts, size, topology and box; its warnings to stderr.
void print_mesh(const std::filesystem::path& file, const MeshReport& report,
                const TriangleMesh& mesh);

/// Prints for people a tree's counts, source, size and levels; and the topology of its triangles,
/// where it keeps any.
void print_tree(const std::filesystem::path& file, const SphereTree& tree,
                const std::optional<MeshReport>& triangles,
                const std::vector<LevelStatistics>& levels);

}  // namespace ist::cli
