#pragma once

#include <chrono>
#include <utility>

#include "ist/scene.h"
#include "loop/scene/table_reader.h"

namespace ist {

// Readers of a scene file's parts, from the outermost table `scene` into `result`, whose unit is
// known. All throw kInputInvalid with file, line and remedy.

/// Reads a scene from a document that was read from `file`, and leaves in the document's tables
/// which keys are known there.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file, TomlTable& document);

/// Reads the tables `fixed` and `held`, including `held.open`, and the array `changes`.
void read_bodies(TableReader& scene, Scene& result);

/// Reads the table `device`.
void read_device(TableReader& scene, Scene& result);

/// Reads the tables below `effects`. A missing table leaves its effect out.
void read_effects(TableReader& scene, Scene& result);

/// Reads the path of a regular file: relative to the scene's folder, or, as ${IST_DATA_DIR}/…, to
/// the folder in that environment variable.
[[nodiscard]] std::filesystem::path read_path(TableReader& table, std::string_view key);

/// Checks the values of a scene that a program may have made: the conditions that read_scene()
/// checks of a file, as far as the library depends on them. Throws kInputInvalid (fail_at).
void check_scene(const Scene& scene);

/// Collects a note for each stage, in the order of building.
class BuildNotes {
 public:
  void skip(std::string what, std::string why) {
    notes_.push_back({std::move(what), false, std::move(why), 0, 0});
  }
  /// Calls `make`, notes its time and the bytes() of its result, and returns the result, a pointer.
  template <typename Make>
  auto make(std::string what, std::string why, const Make& make) {
    const auto begin = std::chrono::steady_clock::now();
    auto made = make();
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    notes_.push_back(
        {std::move(what), true, std::move(why), time.count(), std::uint64_t{made->bytes()}});
    return made;
  }
  [[nodiscard]] std::vector<BuildNote> take() { return std::move(notes_); }

 private:
  std::vector<BuildNote> notes_;
};

struct LoadedBody;

/// Builds the trees that effects need, or takes them from the bodies: one element a body.
/// @param max_memory bytes, for each tree
/// Throws kInputInvalid (fail_at): voxels too small for the mesh or the memory, a tree file without
/// the required spheres or triangles, a body without outside that may be fixed.
[[nodiscard]] std::vector<BodyTrees> build_scene_trees(const Scene& scene,
                                                       std::vector<LoadedBody>& bodies,
                                                       const EffectNeeds& needs,
                                                       std::uint64_t max_memory, BuildNotes& notes,
                                                       Progress* progress);

}  // namespace ist
