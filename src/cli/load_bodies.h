#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/bodies.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"

namespace ist::cli {

/// A mesh read from a file, with warnings of its flaws as sentences.
struct CheckedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings;
};
/// Reads and checks a mesh. Throws kNotAMesh for a tree, and as read_mesh does.
[[nodiscard]] CheckedMesh load_mesh(const std::filesystem::path& file);

/// Prints "warning: …" lines to stderr.
void print_warnings(const std::vector<std::string>& warnings);

/// Builds a tree under a progress bar. Adds warnings that begin with `name` if components were
/// turned outward or the outside is assumed.
[[nodiscard]] SphereTree build_with_progress(const std::string& name, TriangleMesh mesh,
                                             const BuildOptions& options,
                                             std::vector<std::string>& warnings,
                                             BuildReport* report = nullptr);

/// The files of two bodies: each a mesh to build, or a tree to read.
struct BodyFiles {
  /// Whether meshes get voxels, or only one as large as themselves.
  enum class Voxels : std::uint8_t {
    kMade,
    kNeeded,  ///< made where a tree holds no triangles, so that voxels alone can answer
    kNone,
  };

  std::filesystem::path fixed, moving;
  Voxels voxels = Voxels::kMade;
  std::optional<double> voxel_size;    ///< of meshes, mesh units; empty: 1/500 of Bodies::extent()
  std::optional<SpherePolicy> policy;  ///< empty: the tightest that both have
  std::uint64_t max_memory = BuildOptions{}.max_memory;
};

/// Loads both bodies; trees of meshes keep their triangles. Says on stderr which voxel size it
/// takes where none is given. Warns of bodies that seem to be in different units, and of voxels
/// that are large for their body. Throws CLI::ValidationError for a voxel size of two trees, and
/// for two trees of different units.
[[nodiscard]] Bodies load_bodies(const BodyFiles& files);

/// Loads one body whose voxels nobody asks of: a mesh gets one as large as itself.
[[nodiscard]] SphereTree load_body(const std::filesystem::path& file, std::uint64_t max_memory);

}  // namespace ist::cli
