#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/bench/contest.h"

namespace ist::cli {

/// Two contestants who answer the same question, and the words for both.
struct Ratio {
  std::string words;     ///< "table against table"
  std::size_t of, over;  ///< the times of the second over those of the first
};

/// Ratios under one title.
struct RatioGroup {
  std::string title;
  std::vector<Ratio> ratios;
};

/// Returns every ratio that the contest allows. First the fast query's to the published one, by the
/// same policy and then by the tightest against the published table, which lists more pairs; then
/// those of pairs that are kept, and those to other libraries.
[[nodiscard]] std::vector<RatioGroup> ratios_of(const std::vector<Contestant>& contestants);

}  // namespace ist::cli
