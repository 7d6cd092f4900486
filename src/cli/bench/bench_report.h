#pragma once

#include <optional>
#include <string>

#include "cli/bench/contest.h"
#include "cli/bench/machine.h"

namespace ist::cli {

/// Everything that a bench tells beside its times.
struct BenchSetting {
  Machine machine;
  std::string target;  ///< the instruction set
  std::string bodies;  ///< a sentence: triangles, voxels, time to build
  std::string rivals;  ///< names and versions; empty: none was asked
};

/// Prints the setting, then ratios, then times, for people.
void print_bench(const BenchSetting& setting, const Contest& contest);

/// Prints the setting, ratios and times as lines of JSON.
void print_bench_json(const BenchSetting& setting, const Contest& contest);

}  // namespace ist::cli
