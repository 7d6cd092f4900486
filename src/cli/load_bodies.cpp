#include "cli/load_bodies.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/extents.h"
#include "cli/progress_bar.h"
#include "cli/refusals.h"
#include "cli/source_file.h"
#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"

namespace ist::cli {
namespace {

// A body before its tree is built.
struct LoadedBody {
  explicit LoadedBody(const std::filesystem::path& path) : file(path) {
    if (is_tree_file(file)) {
      tree = read_tree(file);
    } else {
      source = source_of(file);
      checked = load_mesh(file);
    }
    extent = largest_extent(tree ? box_of(*tree) : box_of(checked.mesh));
  }
  [[nodiscard]] std::string name() const { return file.string(); }
  [[nodiscard]] bool has_triangles() const { return !tree || tree->triangles() != nullptr; }

  std::filesystem::path file;
  std::optional<SphereTree> tree;  // empty of a mesh
  CheckedMesh checked;
  MeshSource source;
  double extent = 0;
};

// Takes the tree out of `body`, or builds it of its mesh; without a voxel size, of one voxel.
SphereTree take_tree(LoadedBody& body, const BodyFiles& files, std::optional<double> voxel_size) {
  if (body.tree) return std::move(*body.tree);
  BuildOptions options;
  // A mesh without an extent is refused as such, not for its voxels.
  options.voxel_size = voxel_size.value_or(body.extent > 0 ? body.extent : 1);
  options.spheres = files.policy.value_or(options.spheres);
  options.max_memory = files.max_memory;
  options.source = body.source;
  SphereTree tree = build_with_progress(body.name(), std::move(body.checked.mesh), options,
                                        body.checked.warnings);
  print_warnings(body.checked.warnings);
  return tree;
}

void refuse_different_units(const LoadedBody& fixed, const LoadedBody& moving) {
  if (!fixed.tree || !moving.tree) return;
  const LengthUnit one = fixed.tree->source().unit, other = moving.tree->source().unit;
  constexpr LengthUnit kUnknown = LengthUnit::kUnknown;
  refuse_if(one != other && one != kUnknown && other != kUnknown, moving.name(),
            fmt::format("its unit is {}, and that of {} is {}: nothing is converted in silence: "
                        "convert one of the meshes, and build it again with the other's --unit",
                        to_string(other), fixed.name(), to_string(one)));
}

void warn_of_units(const LoadedBody& fixed, const LoadedBody& moving) {
  constexpr double kRatio = 10;
  const double smaller = std::min(fixed.extent, moving.extent);
  if (!(std::max(fixed.extent, moving.extent) > kRatio * smaller)) return;
  print_warnings(
      {fmt::format("the largest extent of {} is {:.4g}, and that of {} is {:.4g}: are they in one "
                   "unit?",
                   fixed.name(), fixed.extent, moving.name(), moving.extent)});
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

Bodies load_bodies(const BodyFiles& files) {
  LoadedBody fixed(files.fixed), moving(files.moving);
  const bool both_are_trees = fixed.tree && moving.tree;
  refuse_if(both_are_trees && files.voxel_size, "--voxel-size",
            "both bodies are trees, which have their own voxel sizes: leave it out");
  refuse_different_units(fixed, moving);
  warn_of_units(fixed, moving);
  using Voxels = BodyFiles::Voxels;
  const bool triangles = fixed.has_triangles() && moving.has_triangles();
  const bool voxels =
      files.voxels == Voxels::kMade || (files.voxels == Voxels::kNeeded && !triangles);
  std::optional<double> voxel_size = files.voxel_size;
  if (!both_are_trees && !voxel_size && voxels) {
    voxel_size = default_voxel_size(std::min(fixed.extent, moving.extent),
                                    "the smaller body's largest extent");
  }
  Bodies bodies{take_tree(fixed, files, voxel_size), take_tree(moving, files, voxel_size),
                SpherePolicy::kTable};
  bodies.policy =
      files.policy.value_or(std::min(bodies.fixed.tightest(), bodies.moving.tightest()));
  bodies.fixed.require(bodies.policy, fixed.name());
  bodies.moving.require(bodies.policy, moving.name());
  if (fixed.tree || voxel_size) bodies.fixed_voxel_size = bodies.fixed.voxel_size();
  if (moving.tree || voxel_size) bodies.moving_voxel_size = bodies.moving.voxel_size();
  if (!voxels) return bodies;
  for (const auto& [body, tree] : {std::pair(&fixed, &bodies.fixed), {&moving, &bodies.moving}}) {
    const auto warning = voxel_warning(body->name(), tree->voxel_size(), body->extent);
    if (warning) print_warnings({*warning});
  }
  return bodies;
}

SphereTree load_body(const std::filesystem::path& file, std::uint64_t max_memory) {
  LoadedBody body(file);
  BodyFiles files;
  files.max_memory = max_memory;
  return take_tree(body, files, {});
}

}  // namespace ist::cli
