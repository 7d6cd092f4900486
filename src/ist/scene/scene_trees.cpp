
#include <fmt/format.h>

#include "ist/base/error.h"
#include "ist/scene/load_body.h"
#include "ist/scene/scene_lines.h"
#include "ist/scene/scene_parts.h"
#include "ist/tree/proximity_body.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/voxelizer.h"

namespace ist {
namespace {

// The extent of proximity voxels from the surface, in voxel edges.
constexpr double kProximityEdges = 2;

constexpr const char* kDistance = "effects.proximity.distance";

class TreeBuilder {
 public:
  TreeBuilder(const Scene& scene, std::uint64_t max_memory, BuildNotes& notes, Progress* progress)
      : scene_(scene), max_memory_(max_memory), notes_(notes), progress_(progress) {}

  void build_contact_trees(LoadedBody& fixed, LoadedBody& held, bool triangles) {
    trees_.fixed = contact_tree(fixed, scene_.fixed, triangles);
    trees_.held = contact_tree(held, scene_.held, triangles);
  }
  void build_near_trees(const LoadedBody& fixed, const LoadedBody& held);
  [[nodiscard]] SceneTrees take() { return std::move(trees_); }

 private:
  using Tree = std::unique_ptr<const SphereTree>;

  [[nodiscard]] Tree contact_tree(LoadedBody& body, const SceneBody& named, bool triangles);
  [[nodiscard]] double near_voxel_size(const LoadedBody& fixed, const LoadedBody& held) const;
  void check_tree(const LoadedBody& body, const SceneBody& named, bool triangles) const;
  // `key` is the scene's key of the voxel size.
  [[nodiscard]] Tree build(const LoadedBody& body, const std::string& key, BuildOptions options);

  const Scene& scene_;
  std::uint64_t max_memory_;
  BuildNotes& notes_;
  Progress* progress_;
  SceneTrees trees_;
};

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
void TreeBuilder::check_tree(const LoadedBody& body, const SceneBody& named, bool triangles) const {
  if (triangles && body.tree->triangles() == nullptr) {
    fail_at(scene_, fmt::format("{}.file", body.table),
            fmt::format("an effect needs triangles, and {} has none: name the mesh, or build the "
                        "tree without --no-triangles",
                        body.name));
  }
  if (!named.spheres || body.tree->has(*named.spheres)) return;
  fail_at(scene_, fmt::format("{}.spheres", body.table),
          fmt::format("spheres = \"{0}\" in [{1}], and {2} has none: build the tree "
                      "with --spheres {0}, or take the key out",
                      to_string(*named.spheres), body.table, body.name));
}

TreeBuilder::Tree TreeBuilder::contact_tree(LoadedBody& body, const SceneBody& named,
                                            bool triangles) {
  const std::string why = fmt::format("{}, for contacts", body.name);
  return notes_.make(fmt::format("{} tree", body.table), why, [&] {
    if (body.tree) {
      check_tree(body, named, triangles);
      return std::move(body.tree);
    }
    return build(body, fmt::format("{}.voxel_size", body.table),
                 {.voxel_size = *named.voxel_size,
                  .spheres = named.spheres.value_or(SpherePolicy::kSlab),
                  .keep_triangles = triangles});
  });
}

double TreeBuilder::near_voxel_size(const LoadedBody& fixed, const LoadedBody& held) const {
  if (!scene_.proximity) {
    fail_at(scene_, "effects.proximity",
            "an effect needs proximity voxels, whose size is half of the distance: add the table "
            "with a distance; damping = 0 makes it no brake");
  }
  const double size = scene_.proximity->distance / (kProximityEdges * scene_.unit);
  for (const LoadedBody* body : {&fixed, &held}) {
    if (!body->mesh) {
      fail_at(scene_, "effects.proximity",
              fmt::format("proximity needs triangles, and {} has none: name the mesh, or "
                          "build the tree without --no-triangles",
                          body->name));
    }
    if (const std::optional<Error> flaw = lattice_flaw(*body->mesh, size)) {
      fail_at(
          scene_, kDistance,
          fmt::format("proximity voxels have half that size: {}: {}", body->name, flaw->what()));
    }
  }
  return size;
}

void TreeBuilder::build_near_trees(const LoadedBody& fixed, const LoadedBody& held) {
  const double size = near_voxel_size(fixed, held);
  const std::string why = fmt::format("voxels of {:.3g}, for effects.proximity", size);
  trees_.near_fixed = notes_.make("proximity voxels", why, [&] {
    const Tree tree = build(fixed, kDistance,
                            {.voxel_size = size,
                             .spheres = SpherePolicy::kTable,
                             .keep_triangles = false,
                             .proximity = true});
    if (!tree->parts().proximity) {
      fail_at(scene_, "effects.proximity",
              fmt::format("{} has no outside: repair the mesh, or take the table out", fixed.name));
    }
    return std::make_unique<const SphereTree>(proximity_body(*tree));
  });
  trees_.near_held = notes_.make("held tree, coarse", why, [&] {
    return build(held, kDistance,
                 {.voxel_size = size, .spheres = SpherePolicy::kTight, .keep_triangles = false});
  });
}

}  // namespace

SceneTrees build_scene_trees(const Scene& scene, LoadedBody& fixed, LoadedBody& held,
                             const EffectNeeds& needs, std::uint64_t max_memory, BuildNotes& notes,
                             Progress* progress) {
  TreeBuilder builder(scene, max_memory, notes, progress);
  if (needs.contacts()) {
    builder.build_contact_trees(fixed, held, needs.triangles);
  } else {
    const bool outside_is_known = fixed.outside_is_known && held.outside_is_known;
    for (const LoadedBody* body : {&fixed, &held}) {
      notes.skip(fmt::format("{} tree", body->table),
                 outside_is_known ? "no effect needs contacts"
                                  : "the outside is not known, so no contact is felt");
    }
  }
  if (needs.proximity) {
    builder.build_near_trees(fixed, held);
  } else {
    notes.skip("proximity voxels", "no effect needs them");
  }
  return builder.take();
}

}  // namespace ist
