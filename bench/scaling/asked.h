#pragma once

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "ist/query/query.h"
#include "support/latencies.h"

namespace ist::bench {

/// The answers about a pose, each time it was asked.
struct Asked {
  Latencies times;
  QueryResult result;
  std::uint64_t rounds = 0;
  std::uint64_t worth = 0;   ///< of them, those with work enough for a second worker,
  std::uint64_t shared = 0;  ///< and those it took part in
};

struct AskOptions {
  int rounds;
  int workers = 1;
  std::chrono::nanoseconds period{0};  ///< from query to query; 0: each at once after the last
};

/// Asks about each pose in turn, by the tightest spheres that both trees have, round after round,
/// so that none is asked twice in a row where there are others. Ends the program where an answer is
/// not whole, not what it was the round before, or not that of the scalar query of one worker.
[[nodiscard]] std::vector<Asked> ask(const std::pair<SphereTree, SphereTree>& trees,
                                     const std::vector<Eigen::Isometry3d>& poses,
                                     const AskOptions& options);

/// Tells times as Latencies::report, and contacts, tests, rounds.
void tell(benchmark::State& state, Asked& asked);

/// Poses that are asked together, when the first of them is to be reported.
class Series {
 public:
  explicit Series(std::function<std::vector<Asked>()> measure) : measure_(std::move(measure)) {}

  /// The median as the benchmark's time, and what tell() tells.
  const Asked& report(benchmark::State& state, std::size_t pose);

 private:
  std::function<std::vector<Asked>()> measure_;
  std::vector<Asked> asked_;
};

}  // namespace ist::bench
