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
  double seconds = 0;  ///< given to all queries together
};

/// Returns the lines before the ratios: what was measured, where, and how fast a fixed loop was
/// meanwhile. A line more says that the machine was not quiet, another one that asking took over
/// 1.1 times the time that it was given. Precondition: `loop` is not empty.
/// @param taken as Contest::taken()
[[nodiscard]] std::string bench_heading(const BenchSetting& setting, const Samples& loop,
                                        double taken);

/// Prints the heading, then ratios, then times, for people.
void print_bench(const BenchSetting& setting, const Contest& contest);

/// Prints the setting, ratios and times as lines of JSON.
void print_bench_json(const BenchSetting& setting, const Contest& contest);

}  // namespace ist::cli
