#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ist/scene.h"
#include "support/temp_dir.h"

namespace ist::test {

/// A scene without flaw, whose lines tests know.
inline constexpr std::string_view kSoundScene = R"(unit = "mm"
rate = 1000
[fixed]
shape = "box"
size = [40, 40, 10]
voxel_size = 1
[held]
shape = "sphere"
radius = 5
voxel_size = 0.5
[device]
kind = "hand"
plan = [
  { time = 0, move = [0, 0, 0] },
  { time = 1, move = [0, 0, -4] },
]
[effects.springs]
stiffness = 20000
)";
/// Its springs, and its last line.
inline constexpr std::string_view kSprings = "[effects.springs]\nstiffness = 20000\n";
inline constexpr std::string_view kLastLine = "stiffness = 20000\n";

/// Returns the text with the first `part` replaced. Throws std::logic_error if there is none.
[[nodiscard]] inline std::string replaced(std::string_view text, std::string_view part,
                                          std::string_view by) {
  const std::size_t at = text.find(part);
  if (at == std::string_view::npos) throw std::logic_error("no part: " + std::string(part));
  return std::string(text.substr(0, at)) + std::string(by) +
         std::string(text.substr(at + part.size()));
}

/// The sound scene with more lines at its end.
[[nodiscard]] inline std::string with_lines(std::string_view lines) {
  return std::string(kSoundScene) + std::string(lines);
}

/// A test that builds scenes, with their files in its own folder.
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
