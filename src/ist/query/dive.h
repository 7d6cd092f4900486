#pragma once

#include <span>

#include "ist/query/bound_lanes.h"
#include "ist/query/search_plan.h"

namespace ist {

/// Some pairs of leaves that are near each other, or deep in each other, found in a straight way
/// down both trees: at each step only the few pairs are opened whose bounds are least apart.
struct Dive {
  static constexpr std::size_t kWidth = 6;
  Contact leaves[kWidth];
  std::size_t count = 0;
  std::uint64_t tests = 0;
  float farthest;  ///< two points of the surfaces are no farther apart, pads included
};

/// Cost: some 130 tests a level, 16 µs in all.
[[nodiscard]] Dive dive(const SearchPlan& plan, const Kernels& kernels, const SearchPose& pose,
                        SearchScratch& scratch) noexcept;

}  // namespace ist
