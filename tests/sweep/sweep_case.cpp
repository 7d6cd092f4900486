#include "sweep/sweep_case.h"

#include <algorithm>
#include <stdexcept>

#include "ist/tree/sphere_tree.h"
#include "support/shapes.h"

namespace ist::test {

SweepTest::SweepTest() {
  write_ball("fixed.ist", 2);
  write_ball("moving.ist", 1);
}

Sweep SweepTest::sweep(std::string_view text) const { return Sweep(dir_.write("job.toml", text)); }

Sweep SweepTest::sweep_with(std::string_view part, std::string_view by) const {
  return sweep(sweep_text(part, by));
}

SweepFolder SweepTest::folder(const Sweep& sweep, const std::string& name) const {
  return {dir_.path() / name, sweep.identity(), sweep.layout(), SweepFolder::Access::kWrite};
}

void SweepTest::run_all(const Sweep& sweep, const SweepFolder& folder, std::size_t threads) const {
  for (std::uint64_t part = 0; part < sweep.parts(); ++part) {
    EXPECT_EQ(sweep.run_part(folder, part, threads), Sweep::Outcome::kMade) << part;
  }
}

void SweepTest::write_ball(const std::string& name, double radius) const {
  write_tree(build_tree(icosphere(2, radius), {.voxel_size = 0.4}), dir_.path() / name);
}

std::vector<std::string> SweepTest::names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string sweep_text(std::string_view part, std::string_view by) {
  const std::string text(kSoundSweep);
  const std::size_t at = text.find(part);
  if (at == std::string::npos) throw std::logic_error("no part: " + std::string(part));
  return text.substr(0, at) + std::string(by) + text.substr(at + part.size());
}

}  // namespace ist::test
