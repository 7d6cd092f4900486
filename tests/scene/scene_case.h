#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "ist/scene.h"
#include "scene/scene_text.h"
#include "support/temp_dir.h"

namespace ist::test {

/// A test of what is built of scenes, whose files are in a folder of its own.
class SceneCase : public ::testing::Test {
 protected:
  [[nodiscard]] Scene scene_of(std::string_view text) const {
    return read_scene(dir_.write("scene.toml", std::string(text)));
  }
  [[nodiscard]] BuiltScene built(std::string_view text) const {
    return build_scene(scene_of(text));
  }
  /// The note of that name; the test fails without it.
  [[nodiscard]] static BuildNote note_of(const BuiltScene& scene, std::string_view what) {
    const auto found = std::find_if(scene.notes.begin(), scene.notes.end(),
                                    [&](const BuildNote& note) { return note.what == what; });
    if (found != scene.notes.end()) return *found;
    ADD_FAILURE() << "no note of " << what;
    return {};
  }
  /// Whether a warning holds that text.
  [[nodiscard]] static bool warns(const BuiltScene& scene, std::string_view text) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(), [&](const std::string& each) {
      return each.find(text) != std::string::npos;
    });
  }

  const TempDir dir_;
};

}  // namespace ist::test
