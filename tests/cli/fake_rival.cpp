// A library to ask beside this one that every build has: the tests' second command is linked with
// it. Its answers are known, and name the meshes that it was given.
#include "cli/bench/rivals.h"

namespace ist::cli {
namespace {

std::vector<Contestant> contestants(const TriangleMesh& fixed, const TriangleMesh& moving,
                                    std::span<const BenchPose>) {
  const std::size_t triangles[] = {fixed.triangles.size(), moving.triangles.size()};
  const auto touch = [](std::size_t) { return Contestant::Answer{5000, std::nullopt}; };
  const auto pairs = [triangles](std::size_t pose) {
    return Contestant::Answer{7000, triangles[pose]};
  };
  return {{"touch", "fake", "", 1, touch}, {"triangle pairs", "fake", "", 1, pairs}};
}

}  // namespace

std::vector<Rival> rivals() { return {{"fake", "1.2", true, contestants}, {"absent", ""}}; }

}  // namespace ist::cli
