#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "support/temp_dir.h"
#include "sweep/sweep.h"

namespace ist::test {

/// A sweep of two balls, of radius 2 and 1, at 10 poses in parts of 4; some touch.
inline constexpr std::string_view kSoundSweep = R"(answers = ["intersects", "distance", "contacts"]
tolerance = 0.01
rows_per_part = 4
[fixed]
tree = "fixed.ist"
[moving]
tree = "moving.ist"
[poses.box]
seed = 7
count = 10
from = [-3, -3, -3]
to = [3, 3, 3]
turns_within = [10, 20, 30]
)";

/// A sweep in a folder of its own, with two trees and the sweep file `job.toml`.
class SweepTest : public ::testing::Test {
 protected:
  SweepTest();

  /// Writes a sweep file, by default the sound one, and opens it.
  [[nodiscard]] Sweep sweep(std::string_view text = kSoundSweep) const;
  /// Writes the sound file with one part of its text replaced, which must be there, and opens it.
  [[nodiscard]] Sweep sweep_with(std::string_view part, std::string_view by) const;
  /// The folder of its parts.
  [[nodiscard]] SweepFolder folder(const Sweep& sweep, const std::string& name = "out") const;
  /// Makes all parts.
  void run_all(const Sweep& sweep, const SweepFolder& folder, std::size_t threads = 1) const;
  /// Writes a tree of a ball under a name, over an older one.
  void write_ball(const std::string& name, double radius) const;
  /// The names in a folder, in order.
  [[nodiscard]] static std::vector<std::string> names_in(const std::filesystem::path& folder);

  TempDir dir_;
};

/// The sound sweep's text with a part of it replaced, which must be there.
[[nodiscard]] std::string sweep_text(std::string_view part, std::string_view by);

}  // namespace ist::test
