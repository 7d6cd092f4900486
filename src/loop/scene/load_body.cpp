#include "loop/scene/load_body.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "ist/base/error.h"
#include "ist/mesh/bounding_box.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/voxelizer.h"
#include "loop/haptics/tool.h"
#include "loop/scene/scene_lines.h"

namespace ist {
namespace {

void require_unit(const LoadedBody& body, LengthUnit unit, const Scene& scene) {
  if (unit == LengthUnit::kUnknown || metres_per_unit(unit) == scene.unit) return;
  fail_at(scene, "unit",
          fmt::format("{} is in {}: write this unit, or convert the mesh to the scene's unit",
                      body.name, to_string(unit)));
}

Eigen::AlignedBox3d box_of_voxels(const SphereTree& tree) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& centre : tree.leaf_centres()) box.extend(centre);
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * tree.voxel_size());
  return {box.min() - half, box.max() + half};
}

// Sets the frame of a body whose mesh or tree is known.
void set_frame(LoadedBody& body, const std::optional<Eigen::Vector3d>& origin) {
  const Eigen::AlignedBox3d box = body.mesh ? bounding_box(*body.mesh) : box_of_voxels(*body.tree);
  body.diagonal = std::sqrt(box.sizes().squaredNorm());
  body.origin = origin.value_or(body.mesh ? Eigen::Vector3d(box.center()) : body.tree->origin());
  if (!body.mesh) {
    const double away = std::sqrt((body.origin - body.tree->origin()).squaredNorm());
    body.radius = surface_radius(*body.tree) + away;
    return;
  }
  double farthest2 = 0;
  for (const Eigen::Vector3d& vertex : body.mesh->vertices) {
    farthest2 = std::max(farthest2, (vertex - body.origin).squaredNorm());
  }
  body.radius = std::sqrt(farthest2) * (1 + 1e-9);
}

void take_tree(LoadedBody& body, const std::filesystem::path& file, bool voxels,
               const Scene& scene) {
  body.tree = std::make_unique<const SphereTree>(read_tree(file));
  const bool lacks_voxels = voxels && !body.tree->has_voxels();
  if (lacks_voxels || (scene.contact && body.tree->triangles() == nullptr)) {
    fail_at(scene, fmt::format("{}.file", body.table),
            lacks_voxels
                ? fmt::format("{} has no voxels, which springs need: name the mesh with a "
                              "voxel_size, or build the tree with one",
                              body.name)
                : fmt::format("{} has no triangles, which contact needs: name the mesh, or build "
                              "the tree without --no-triangles",
                              body.name));
  }
  require_unit(body, body.tree->source().unit, scene);
  body.outside_is_known = body.tree->orientation() == Orientation::kOutward;
  body.frame = body.tree->frame();
  if (body.tree->triangles()) {
    body.mesh = std::make_unique<TriangleMesh>(parts_of(*body.tree).triangles->mesh);
  }
  if (voxels) body.voxel_size = body.tree->voxel_size();
}

void take_mesh(LoadedBody& body, TriangleMesh mesh, bool voxels, const Scene& scene) {
  if (voxels) {
    if (!body.named->voxel_size) {
      fail_at(scene, fmt::format("{}.voxel_size", body.table),
              "an effect of the program acts between voxels: give the edge of a voxel, or add "
              "[effects.contact]");
    }
    body.voxel_size = *body.named->voxel_size;
    if (const std::optional<Error> flaw = lattice_flaw(mesh, body.voxel_size)) {
      fail_at(scene, fmt::format("{}.voxel_size", body.table),
              fmt::format("{}: {}", body.name, flaw->what()));
    }
  }
  require_unit(body, mesh.unit, scene);
  body.frame = mesh.frame;
  body.mesh = std::make_unique<TriangleMesh>(std::move(mesh));
  body.outside_is_known = orient_outward(*body.mesh).orientation == Orientation::kOutward;
}

LoadedBody load_body(const Scene& scene, const SceneBody& body, bool held, std::string table,
                     bool voxels, std::vector<std::string>& warnings) {
  LoadedBody loaded{};
  loaded.named = &body;
  loaded.held = held;
  loaded.table = std::move(table);
  if (const auto* shape = std::get_if<BuiltInShape>(&body.source)) {
    loaded.name = fmt::format("the {} shape", body.name);
    take_mesh(loaded, make_shape(*shape), voxels, scene);
  } else {
    const auto& file = std::get<std::filesystem::path>(body.source);
    loaded.name = file.string();
    if (!body.voxel_size && is_tree_file(file)) {
      take_tree(loaded, file, voxels, scene);
    } else {
      TriangleMesh mesh = read_mesh(file);
      for (const std::string& warning : ist::warnings(check_mesh(mesh))) {
        warnings.push_back(fmt::format("{}: {}", loaded.name, warning));
      }
      take_mesh(loaded, std::move(mesh), voxels, scene);
    }
  }
  loaded.outside_is_known |= body.trust_normals;
  const bool is_tool = &body == scene.held.data();
  set_frame(loaded, is_tool ? scene.origin : std::nullopt);
  return loaded;
}

}  // namespace

std::vector<LoadedBody> load_bodies(const Scene& scene, bool voxels,
                                    std::vector<std::string>& warnings) {
  std::vector<LoadedBody> bodies;
  const auto load = [&](const std::vector<SceneBody>& all, const char* key, bool held) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      bodies.push_back(
          load_body(scene, all[i], held, path_of_body(key, i, all.size()), voxels, warnings));
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
