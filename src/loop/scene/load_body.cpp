#include "loop/scene/load_body.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "ist/base/error.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/voxelizer.h"
#include "loop/scene/scene_lines.h"

namespace ist {
namespace {

void require_unit(const LoadedBody& body, LengthUnit unit, const Scene& scene) {
  if (unit == LengthUnit::kUnknown || metres_per_unit(unit) == scene.unit) return;
  fail_at(scene, "unit",
          fmt::format("{} is in {}: write this unit, or convert the mesh to the scene's unit",
                      body.name, to_string(unit)));
}

double diagonal_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return std::sqrt(box.sizes().squaredNorm());
}

double diagonal_of(const SphereTree& tree) {
  Eigen::AlignedBox3d centres;
  for (const Eigen::Vector3d& centre : tree.leaf_centres()) centres.extend(centre);
  const Eigen::Vector3d sizes = centres.sizes().array() + tree.voxel_size();
  return std::sqrt(sizes.squaredNorm());
}

void take_tree(LoadedBody& body, const std::filesystem::path& file, const Scene& scene) {
  body.tree = std::make_unique<const SphereTree>(read_tree(file));
  if (!body.tree->has_voxels()) {
    fail_at(
        scene, fmt::format("{}.file", body.table),
        fmt::format("{} has no voxels, which contacts need: name the mesh with a voxel_size, or "
                    "build the tree with one",
                    body.name));
  }
  require_unit(body, body.tree->source().unit, scene);
  body.outside_is_known = body.tree->orientation() == Orientation::kOutward;
  body.frame = body.tree->frame();
  body.origin = body.tree->origin();
  if (body.tree->triangles()) {
    body.mesh = std::make_unique<TriangleMesh>(parts_of(*body.tree).triangles->mesh);
  }
  body.voxel_size = body.tree->voxel_size();
  body.diagonal = body.mesh ? diagonal_of(*body.mesh) : diagonal_of(*body.tree);
}

void take_mesh(LoadedBody& body, TriangleMesh mesh, double voxel_size, const Scene& scene) {
  if (const std::optional<Error> flaw = lattice_flaw(mesh, voxel_size)) {
    fail_at(scene, fmt::format("{}.voxel_size", body.table),
            fmt::format("{}: {}", body.name, flaw->what()));
  }
  require_unit(body, mesh.unit, scene);
  body.frame = mesh.frame;
  body.voxel_size = voxel_size;
  body.diagonal = diagonal_of(mesh);
  body.mesh = std::make_unique<TriangleMesh>(std::move(mesh));
  body.outside_is_known = orient_outward(*body.mesh).orientation == Orientation::kOutward;
  body.origin = lattice_of(*body.mesh, voxel_size).origin();
}

LoadedBody load_body(const Scene& scene, const SceneBody& body, bool held, std::string table,
                     std::vector<std::string>& warnings) {
  LoadedBody loaded{};
  loaded.named = &body;
  loaded.held = held;
  loaded.table = std::move(table);
  if (const auto* shape = std::get_if<BuiltInShape>(&body.source)) {
    loaded.name = fmt::format("the {} shape", body.name);
    take_mesh(loaded, make_shape(*shape), *body.voxel_size, scene);
  } else {
    const auto& file = std::get<std::filesystem::path>(body.source);
    loaded.name = file.string();
    if (body.voxel_size) {
      TriangleMesh mesh = read_mesh(file);
      for (const std::string& warning : ist::warnings(check_mesh(mesh))) {
        warnings.push_back(fmt::format("{}: {}", loaded.name, warning));
      }
      take_mesh(loaded, std::move(mesh), *body.voxel_size, scene);
    } else {
      take_tree(loaded, file, scene);
    }
  }
  loaded.outside_is_known |= body.trust_normals;
  return loaded;
}

}  // namespace

std::vector<LoadedBody> load_bodies(const Scene& scene, std::vector<std::string>& warnings) {
  std::vector<LoadedBody> bodies;
  const auto load = [&](const std::vector<SceneBody>& all, const char* key, bool held) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      bodies.push_back(load_body(scene, all[i], held, path_of_body(key, i, all.size()), warnings));
    }
  };
  load(scene.fixed, "fixed", false);
  load(scene.held, "held", true);
  for (const LoadedBody& a : bodies) {
    for (const LoadedBody& b : bodies) {
      if (!contradict(a.frame, b.frame)) continue;
      fail_at(
          scene, b.table,
          fmt::format("{} is in the frame {} and {} in {}: turn one of them by 'ist build "
                      "--to-frame {}', and name its tree",
                      b.name, to_string(b.frame), a.name, to_string(a.frame), to_string(a.frame)));
    }
  }
  return bodies;
}

}  // namespace ist
