#include "cli/bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/progress_bar.h"
#include "cli/refusals.h"
#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

namespace ist::cli {
namespace {

SphereTree load_body(const std::filesystem::path& file, bool is_tree, const BodyFiles& files) {
  if (is_tree) return read_tree(file);
  CheckedMesh checked = load_mesh(file);
  BuildOptions options;
  options.voxel_size = *files.voxel_size;
  options.spheres = files.policy.value_or(options.spheres);
  options.max_memory = files.max_memory;
  SphereTree tree =
      build_with_progress(file.string(), std::move(checked.mesh), options, checked.warnings);
  print_warnings(checked.warnings);
  return tree;
}

}  // namespace

CheckedMesh load_mesh(const std::filesystem::path& file) {
  if (is_tree_file(file)) {
    throw Error(
        ErrorCode::kNotAMesh,
        fmt::format("{}: this is a tree: name the mesh that it was built from", file.string()));
  }
  CheckedMesh checked{read_mesh(file), {}};
  for (const std::string& warning : warnings(check_mesh(checked.mesh))) {
    checked.warnings.push_back(fmt::format("{}: {}", file.string(), warning));
  }
  return checked;
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }
}

SphereTree build_with_progress(const std::string& name, TriangleMesh mesh,
                               const BuildOptions& options, std::vector<std::string>& warnings,
                               BuildReport* report) {
  ProgressBar progress;
  BuildReport own;
  BuildReport& filled = report != nullptr ? *report : own;
  SphereTree tree = build_tree(std::move(mesh), options, &filled, &progress);
  if (filled.turned_components > 0) {
    warnings.push_back(fmt::format("{}: {} closed component{} inside out: turned outward", name,
                                   filled.turned_components,
                                   filled.turned_components == 1 ? " was" : "s were"));
  }
  if (tree.orientation() == Orientation::kAssumed) {
    warnings.push_back(
        fmt::format("{}: not closed or not wound consistently: its outside is assumed from the "
                    "winding of its triangles",
                    name));
  }
  return tree;
}

double Bodies::extent() const {
  const auto largest = [](const SphereTree& tree) {
    return tree.voxel_size() * static_cast<double>(tree.parts().lattice.cells);
  };
  return std::min(largest(fixed), largest(moving));
}

Bodies load_bodies(const BodyFiles& files) {
  const bool fixed_is_tree = is_tree_file(files.fixed), moving_is_tree = is_tree_file(files.moving);
  const bool both_are_trees = fixed_is_tree && moving_is_tree;
  refuse_if(both_are_trees && files.voxel_size, "--voxel-size",
            "both bodies are trees, which have their own voxel sizes: leave it out");
  refuse_if(!both_are_trees && !files.voxel_size, "--voxel-size",
            fmt::format("needed, because {} is a mesh: give the edge of a voxel in mesh units",
                        fixed_is_tree ? files.moving.string() : files.fixed.string()));
  Bodies bodies{load_body(files.fixed, fixed_is_tree, files),
                load_body(files.moving, moving_is_tree, files), SpherePolicy::kTable};
  bodies.policy =
      files.policy.value_or(std::min(bodies.fixed.tightest(), bodies.moving.tightest()));
  bodies.fixed.require(bodies.policy, files.fixed.string());
  bodies.moving.require(bodies.policy, files.moving.string());
  return bodies;
}

void require_triangles(const Bodies& bodies) {
  for (const auto& [tree, name] : {std::pair(&bodies.fixed, "FIXED"), {&bodies.moving, "MOVING"}}) {
    if (tree->triangles()) continue;
    throw Error(
        ErrorCode::kTrianglesMissing,
        fmt::format("{}: the tree has no triangles: build it without --no-triangles, or name the "
                    "mesh",
                    name));
  }
}

}  // namespace ist::cli
