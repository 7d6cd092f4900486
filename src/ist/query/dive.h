#pragma once

#include <span>

#include "ist/query/bound_lanes.h"
#include "ist/query/search_plan.h"

namespace ist {

/// Some pairs of leaves that are near each other, found in a straight way down both trees: at each
/// step only the few pairs are opened that can be no farther apart than others can.
struct Dive {
  static constexpr std::size_t kWidth = 8;
  Contact leaves[kWidth];
  std::size_t count = 0;
  std::uint64_t tests = 0;
  float farthest;  ///< two points of the surfaces are no farther apart, pads included
};

/// Cost: some 300 tests a level, one by one.
[[nodiscard]] Dive dive(const SearchPlan& plan, const SearchPose& pose,
                        SearchScratch& scratch) noexcept;

}  // namespace ist
