#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ist/mesh/triangle_mesh.h"
#include "ist/tree/tree_builder.h"

namespace ist::cli {

/// A mesh from a file, with what is wrong with it in sentences for people.
struct CheckedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings;
};
[[nodiscard]] CheckedMesh load_mesh(const std::filesystem::path& file);

/// Prints "warning: …" lines to stderr.
void print_warnings(const std::vector<std::string>& warnings);

/// Builds a tree under a progress bar; what had to be turned or assumed of the mesh, which is
/// called `name`, is added to `warnings`.
[[nodiscard]] SphereTree build_with_progress(const std::string& name, TriangleMesh mesh,
                                             const BuildOptions& options,
                                             std::vector<std::string>& warnings,
                                             BuildReport* report = nullptr);

/// The two bodies of a query: each a mesh, which is built, or a tree, which is read.
struct Bodies {
  SphereTree fixed, moving;
  SpherePolicy policy;
};

struct BodyFiles {
  std::filesystem::path fixed, moving;
  std::optional<double> voxel_size;    ///< for meshes
  std::optional<SpherePolicy> policy;  ///< none: the best that both have
  bool keep_triangles = false;         ///< of meshes
  std::uint64_t max_memory = BuildOptions{}.max_memory;
};

/// Throws CLI::ValidationError when the voxel size is missing, or given for two trees.
[[nodiscard]] Bodies load_bodies(const BodyFiles& files);

}  // namespace ist::cli
