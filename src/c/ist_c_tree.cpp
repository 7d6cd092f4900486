#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "c/objects.h"
#include "ist/base/float_environment.h"
#include "ist/measure/penetration.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

namespace ist::capi {
namespace {

BuildOptions read_build_options(Call& call, const ist_build_options& known) {
  if (!are_spheres(known.spheres)) {
    call.fail(IST_ARGUMENT_INVALID, "options->spheres is {}: pass one of IST_SPHERES_...",
              known.spheres);
  }
  const auto is_flag = [](std::int32_t value) { return value == 0 || value == 1; };
  if (!is_flag(known.drop_triangles) || !is_flag(known.proximity) || !is_flag(known.no_weld)) {
    call.fail(IST_ARGUMENT_INVALID,
              "options->drop_triangles is {}, proximity is {} and no_weld is {}: pass 0 or "
              "1 for each",
              known.drop_triangles, known.proximity, known.no_weld);
  }
  if (known.frame < IST_FRAME_UNKNOWN || known.frame > IST_FRAME_LPS) {
    call.fail(IST_ARGUMENT_INVALID, "options->frame is {}: pass one of IST_FRAME_...", known.frame);
  }
  if (known.reserved != 0) {
    call.fail(IST_ARGUMENT_INVALID, "options->reserved is {}: set it to 0", known.reserved);
  }
  BuildOptions options;
  options.frame = static_cast<PatientFrame>(known.frame);
  options.voxel_size = known.voxel_size;
  options.spheres = policy_of(known.spheres).value_or(options.spheres);
  options.keep_triangles = known.drop_triangles == 0;
  options.proximity = known.proximity == 1;
  options.weld = known.no_weld == 0;
  if (known.max_memory > 0) options.max_memory = known.max_memory;
  return options;
}

// The stages that a build begins.
unsigned stages_of(const BuildOptions& options) {
  constexpr unsigned kAlways = 1, kOfVoxels = 4;
  if (options.voxel_size == 0) return kAlways;
  return kAlways + kOfVoxels + (is_implicit(options.spheres) ? 0U : 1U) +
         (options.proximity ? 1U : 0U);
}

ist_tree_info tree_info_of(const Tree& object) {
  const SphereTree& tree = object.tree;
  ist_tree_info info{};
  info.voxel_size = tree.voxel_size();
  info.leaves = tree.leaf_count();
  info.triangles = tree.triangles() ? tree.triangles()->triangles.size() : 0;
  info.bytes = tree.bytes();
  info.depth = tree.depth();
  info.spheres = spheres_of(tree.tightest(), tree.has_voxels());
  info.has_triangles = tree.triangles() != nullptr;
  info.has_proximity = tree.has_proximity();
  info.outward = tree.orientation() == Orientation::kOutward;
  info.unit = static_cast<std::int32_t>(tree.source().unit);
  const Eigen::Vector3d origin = tree.origin();
  std::copy_n(origin.data(), 3, info.origin);
  info.bounding_radius = tree.bounding_radius();
  info.largest_leaf_radius = tree.largest_leaf_radius(tree.tightest());
  info.frame = static_cast<std::int32_t>(tree.frame());
  info.prepared_for_depth = ist::is_prepared_for_depth(tree);
  return info;
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_tree_build(const ist_mesh* mesh, const ist_build_options* options,
                          ist_tree** tree) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("tree", tree);
    const ist_build_options known = read_sized(call, "options", options);
    const ist::BuildOptions build = read_build_options(call, known);
    const Follower follower = read_follower(call, known.progress);
    const Held<Mesh> held(call, "mesh", mesh);
    if (!held) return;
    ist::Progress progress;
    std::unique_ptr<Tree> made;
    const bool whole = followed(follower, progress, stages_of(build), [&] {
      made = std::make_unique<Tree>(ist::build_tree(held->mesh, build, nullptr, &progress));
    });
    whole ? give(call, std::move(made), tree) : cancelled(call);
  });
}

ist_status ist_tree_load(const char* path, const ist_progress* progress,
                         ist_tree** tree) IST_NOEXCEPT {
  return read_object<Tree>(__func__, path, progress, tree,
                           [](const char* file) { return ist::read_tree(file); });
}

ist_status ist_tree_save(const ist_tree* tree, const char* path,
                         const ist_progress* progress) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.need("path", path);
    const Follower follower = read_follower(call, progress);
    const Held<Tree> held(call, "tree", tree);
    if (!held) return;
    bool written = false;
    followed(follower, [&](const ist::Proceed&) {
      ist::write_tree(held->tree, path);
      written = true;
    });
    // A caller who says stop while the file waits for the disk is too late.
    if (!written) cancelled(call);
  });
}

ist_status ist_tree_to_memory(const ist_tree* tree, void* memory, size_t capacity,
                              const ist_progress* progress, uint64_t* bytes) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("bytes", bytes);
    call.need_array("memory", memory, capacity);
    const Follower follower = read_follower(call, progress);
    const Held<Tree> held(call, "tree", tree);
    if (!held) return;
    std::vector<std::byte> file;
    const bool whole =
        followed(follower, [&](const ist::Proceed&) { file = ist::tree_to_bytes(held->tree); });
    if (!whole) return cancelled(call);
    *bytes = file.size();
    if (capacity >= file.size()) std::memcpy(memory, file.data(), file.size());
  });
}

ist_status ist_tree_from_memory(const void* memory, size_t bytes, const ist_progress* progress,
                                ist_tree** tree) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("tree", tree);
    call.need_array("memory", memory, bytes);
    make_object<Tree>(call, progress, tree, [&] {
      return std::make_unique<Tree>(
          ist::tree_from_bytes({static_cast<const std::byte*>(memory), bytes}));
    });
  });
}

ist_status ist_tree_get_mesh(const ist_tree* tree, ist_mesh** mesh) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("mesh", mesh);
    const Held<Tree> held(call, "tree", tree);
    if (!held) return;
    const ist::TriangleMesh* kept = held->tree.triangles();
    if (kept == nullptr) {
      return call.fail(IST_TRIANGLES_MISSING, "the tree keeps no triangles: build it with them");
    }
    give(call, std::make_unique<Mesh>(*kept), mesh);
  });
}

ist_status ist_tree_self_intersections(const ist_tree* tree, uint64_t* pairs) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("pairs", pairs);
    const Held<Tree> held(call, "tree", tree);
    if (!held) return;
    *pairs = held->tree.self_intersections();
  });
}

ist_status ist_tree_prepare_depth(const ist_tree* tree, uint64_t max_memory,
                                  const ist_progress* progress) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    const Follower follower = read_follower(call, progress);
    const Held<Tree> held(call, "tree", tree);
    if (!held) return;
    constexpr unsigned kStages = 3;  // outer balls are placed, painted and filled
    ist::Progress made;
    const bool whole = followed(follower, made, kStages, [&] {
      ist::prepare_depth(held->tree, max_memory > 0 ? max_memory : ist::kMostBallBytes, &made);
    });
    if (!whole) cancelled(call);
  });
}

ist_status ist_tree_get_info(const ist_tree* tree, ist_tree_info* info) IST_NOEXCEPT {
  return get_info<Tree>(__func__, tree, info, tree_info_of);
}

ist_status ist_tree_copy_leaf_centres(const ist_tree* tree, double* centres,
                                      size_t capacity) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.need_array("centres", centres, capacity);
    const Held<Tree> held(call, "tree", tree);
    if (!held) return;
    const std::vector<Eigen::Vector3d> all = held->tree.leaf_centres();
    for (const Eigen::Vector3d& centre : std::span(all).first(std::min(capacity, all.size()))) {
      centres = std::copy_n(centre.data(), 3, centres);
    }
  });
}

ist_status ist_tree_free(ist_tree* tree) IST_NOEXCEPT { return give_back<Tree>(__func__, tree); }
