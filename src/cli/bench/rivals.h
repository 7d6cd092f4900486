#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/bench/contest.h"
#include "ist/mesh/mesh.h"

namespace ist::cli {

/// Another library that `ist bench --against` can ask the same questions.
struct Rival {
  std::string name, version;
  bool here = false;  ///< whether this command was built with it

  /// Makes its contestants, of the exact questions that it answers, in one thread. `poses` must
  /// outlive them. Empty where it is not here.
  std::vector<Contestant> (*contestants)(const TriangleMesh& fixed, const TriangleMesh& moving,
                                         std::span<const BenchPose> poses) = nullptr;
};

/// Returns every rival by name, here or not. Defined in no_rivals.cpp, or where the benchmarks are
/// built in bench/peers/rivals.cpp.
[[nodiscard]] std::vector<Rival> rivals();

}  // namespace ist::cli
