#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

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
[effects.contact]
stiffness = 2000
)";
inline constexpr std::string_view kLastLine = "stiffness = 2000\n";

/// The text with one part of it, which must be there, replaced where it is first found.
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

}  // namespace ist::test
