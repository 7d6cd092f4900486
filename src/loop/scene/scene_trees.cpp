
#include <fmt/format.h>

#include <algorithm>

#include "ist/base/error.h"
#include "ist/tree/proximity_body.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/voxelizer.h"
#include "loop/scene/load_body.h"
#include "loop/scene/scene_lines.h"
#include "loop/scene/scene_parts.h"

namespace ist {
namespace {

// The extent of proximity voxels from the surface, in voxel edges.
constexpr double kProximityEdges = 2;

constexpr const char* kDistance = "effects.proximity.distance";

class TreeBuilder {
 public:
  TreeBuilder(const Scene& scene, std::uint64_t max_memory, BuildNotes& notes, Progress* progress)
      : scene_(scene), max_memory_(max_memory), notes_(notes), progress_(progress) {}

  using Tree = std::unique_ptr<const SphereTree>;

  [[nodiscard]] Tree contact_tree(LoadedBody& body, bool triangles);
  [[nodiscard]] Tree wall_tree(LoadedBody& body);
  [[nodiscard]] double near_voxel_size(const std::vector<LoadedBody>& bodies) const;
  [[nodiscard]] Tree near_tree(const LoadedBody& body, double voxel_size);
  [[nodiscard]] Tree coarse_tree(const LoadedBody& body, double voxel_size);

 private:
  void check_tree(const LoadedBody& body, bool triangles) const;
  // `key` is the scene's key of the voxel size.
  [[nodiscard]] Tree build(const LoadedBody& body, const std::string& key, BuildOptions options);

  const Scene& scene_;
  std::uint64_t max_memory_;
  BuildNotes& notes_;
  Progress* progress_;
};

std::string voxels_of(double size) {
  return fmt::format("voxels of {:.3g}, for effects.proximity", size);
}

TreeBuilder::Tree TreeBuilder::build(const LoadedBody& body, const std::string& key,
                                     BuildOptions options) {
  options.max_memory = max_memory_;
  try {
    return std::make_unique<const SphereTree>(build_tree(*body.mesh, options, nullptr, progress_));
  } catch (const Error& error) {
    fail_at(scene_, key, fmt::format("{}: {}", body.name, error.what()));
  }
}

// Checks that a tree file has the spheres and triangles that the scene needs.
void TreeBuilder::check_tree(const LoadedBody& body, bool triangles) const {
  if (triangles && body.tree->triangles() == nullptr) {
    fail_at(scene_, fmt::format("{}.file", body.table),
            fmt::format("an effect needs triangles, and {} has none: name the mesh, or build the "
                        "tree without --no-triangles",
                        body.name));
  }
  const std::optional<SpherePolicy> spheres = body.named->spheres;
  if (!spheres || body.tree->has(*spheres)) return;
  fail_at(scene_, fmt::format("{}.spheres", body.table),
          fmt::format("spheres = \"{0}\" in [{1}], and {2} has none: build the tree "
                      "with --spheres {0}, or take the key out",
                      to_string(*spheres), body.table, body.name));
}

TreeBuilder::Tree TreeBuilder::contact_tree(LoadedBody& body, bool triangles) {
  const SceneBody& named = *body.named;
  const std::string why = fmt::format("{}, for contacts", body.name);
  return notes_.make(fmt::format("{} tree", named.name), why, [&] {
    if (body.tree) {
      check_tree(body, triangles);
      return std::move(body.tree);
    }
    return build(body, fmt::format("{}.voxel_size", body.table),
                 {.voxel_size = *named.voxel_size,
                  .spheres = named.spheres.value_or(SpherePolicy::kSlab),
                  .keep_triangles = triangles});
  });
}

TreeBuilder::Tree TreeBuilder::wall_tree(LoadedBody& body) {
  const std::string why = fmt::format("{}, triangles for effects.contact", body.name);
  return notes_.make(fmt::format("{} tree", body.named->name), why, [&] {
    if (body.tree) return std::move(body.tree);
    return build(body, body.table, {});
  });
}

double TreeBuilder::near_voxel_size(const std::vector<LoadedBody>& bodies) const {
  if (!scene_.proximity) {
    fail_at(scene_, "effects.proximity",
            "an effect needs proximity voxels, whose size is half of the distance: add the table "
            "with a distance; damping = 0 makes it no brake");
  }
  const double size = scene_.proximity->distance / (kProximityEdges * scene_.unit);
  for (const LoadedBody& body : bodies) {
    if (!body.mesh) {
      fail_at(scene_, "effects.proximity",
              fmt::format("proximity needs triangles, and {} has none: name the mesh, or "
                          "build the tree without --no-triangles",
                          body.name));
    }
    if (const std::optional<Error> flaw = lattice_flaw(*body.mesh, size)) {
      fail_at(scene_, kDistance,
              fmt::format("proximity voxels have half that size: {}: {}", body.name, flaw->what()));
    }
  }
  return size;
}

TreeBuilder::Tree TreeBuilder::near_tree(const LoadedBody& body, double voxel_size) {
  const std::string what = scene_.fixed.size() == 1 && !body.held
                               ? "proximity voxels"
                               : fmt::format("{} voxels", body.named->name);
  return notes_.make(what, voxels_of(voxel_size), [&] {
    const Tree tree = build(body, kDistance,
                            {.voxel_size = voxel_size,
                             .spheres = SpherePolicy::kTable,
                             .keep_triangles = false,
                             .proximity = true});
    if (!voxels_of(*tree).proximity) {
      fail_at(scene_, "effects.proximity",
              fmt::format("{} has no outside: repair the mesh, or take the table out", body.name));
    }
    return std::make_unique<const SphereTree>(proximity_body(*tree));
  });
}

TreeBuilder::Tree TreeBuilder::coarse_tree(const LoadedBody& body, double voxel_size) {
  return notes_.make(fmt::format("{} tree, coarse", body.named->name), voxels_of(voxel_size), [&] {
    return build(
        body, kDistance,
        {.voxel_size = voxel_size, .spheres = SpherePolicy::kTight, .keep_triangles = false});
  });
}

}  // namespace

std::vector<BodyTrees> build_scene_trees(const Scene& scene, std::vector<LoadedBody>& bodies,
                                         const EffectNeeds& needs, std::uint64_t max_memory,
                                         BuildNotes& notes, Progress* progress) {
  TreeBuilder builder(scene, max_memory, notes, progress);
  std::vector<BodyTrees> trees(bodies.size());
  const bool outside_is_known =
      std::all_of(bodies.begin(), bodies.end(), [](const auto& b) { return b.outside_is_known; });
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (scene.contact) {
      trees[i].contact = builder.wall_tree(bodies[i]);
    } else if (needs.contacts()) {
      trees[i].contact = builder.contact_tree(bodies[i], needs.triangles);
    } else {
      notes.skip(fmt::format("{} tree", bodies[i].named->name),
                 outside_is_known ? "no effect needs contacts"
                                  : "the outside is not known, so no contact is felt");
    }
  }
  if (!needs.proximity) {
    notes.skip("proximity voxels", "no effect needs them");
    return trees;
  }
  const double size = builder.near_voxel_size(bodies);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].may_be_fixed()) trees[i].near = builder.near_tree(bodies[i], size);
    if (bodies[i].may_be_held()) trees[i].coarse = builder.coarse_tree(bodies[i], size);
  }
  return trees;
}

}  // namespace ist
