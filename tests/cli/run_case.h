#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "cli/cli_case.h"

namespace ist::test {

/// The text with one part of it, which must be there, replaced where it is first found.
[[nodiscard]] inline std::string replaced(std::string text, const std::string& part,
                                          const std::string& by) {
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), by);
}

[[nodiscard]] inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// A test of `ist run`.
class RunCase : public CliTest {
 protected:
  [[nodiscard]] static std::string shipped(const std::string& name) {
    return std::string(IST_SCENES) + "/" + name + ".toml";
  }
  /// A shipped scene with one part of it replaced.
  [[nodiscard]] std::string altered(const std::string& name, const std::string& part,
                                    const std::string& by) const {
    return write(name + ".toml", replaced(file_content(shipped(name)), part, by));
  }
  /// A box on a box, built in no time.
  [[nodiscard]] std::string boxes() const {
    std::string text = file_content(shipped("slide"));
    for (int body = 0; body < 2; ++body) {
      text = replaced(text, "voxel_size = 0.5", "voxel_size = 1");
    }
    return write("boxes.toml", text);
  }
  /// The jaws, built in no time.
  [[nodiscard]] std::string coarse_jaws() const {
    std::string text = file_content(shipped("jaws"));
    for (int body = 0; body < 2; ++body) {
      text = replaced(text, "voxel_size = 0.5", "voxel_size = 2");
    }
    return write("jaws.toml", replaced(text, "distance = 1\n", "distance = 4\n"));
  }
  /// A ball that is pressed within 0.6 s, and all that there is to feel.
  [[nodiscard]] std::string all_effects() const {
    std::string text = file_content(shipped("press"));
    text = replaced(replaced(text, "time = 1,", "time = 0.2,"), "time = 3,", "time = 0.4,");
    return write("all.toml", replaced(text, "time = 4,", "time = 0.6,") +
                                 "\n[effects.damping]\n[effects.proximity]\n"
                                 "distance = 2\n[effects.gravity]\nmass = 0.05\n[effects.snap]\n"
                                 "move = [0, 0, -1]\nradius = 3\n");
  }
  /// The command's arguments.
  static std::vector<std::string> run(const std::string& scene,
                                      const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", scene};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
};

}  // namespace ist::test
