#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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

/// The two trees of a query, and the sphere policy that it uses.
struct Bodies {
  SphereTree fixed, moving;
  SpherePolicy policy;

  /// Returns the largest extent of the smaller body, mesh units.
  [[nodiscard]] double extent() const;
};

/// The files of two bodies: each a mesh to build, or a tree to read.
struct BodyFiles {
  std::filesystem::path fixed, moving;
  std::optional<double> voxel_size;    ///< of meshes, mesh units
  std::optional<SpherePolicy> policy;  ///< empty: the tightest that both have
  std::uint64_t max_memory = BuildOptions{}.max_memory;
};

/// Loads both bodies. Throws CLI::ValidationError if the voxel size is missing, or given for two
/// trees.
[[nodiscard]] Bodies load_bodies(const BodyFiles& files);

/// Throws kTrianglesMissing, naming the body, where a tree holds no triangles.
void require_triangles(const Bodies& bodies);

}  // namespace ist::cli
