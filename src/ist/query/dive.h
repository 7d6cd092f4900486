#pragma once

#include <span>

#include "ist/query/traversal/search_plan.h"
#include "simd/dispatch.h"
#include "simd/lanes.h"

namespace ist {

/// The leaf pairs found by a beam search down both trees: each step descends from the kWidth pairs
/// of nodes whose bounds are nearest to each other or overlap most.
struct Dive {
  static constexpr std::size_t kWidth = 6;
  LeafPair leaves[kWidth];
  std::size_t count = 0;
  std::uint64_t tests = 0;
  float farthest;  ///< no less than the distance between the surfaces, mesh units, pad included
};

/// Runs the beam search from the roots to the leaves. Cost: some 130 tests a level, 16 µs in all.
[[nodiscard]] Dive dive(const SearchPlan& plan, const Kernels& kernels, const SearchPose& pose,
                        SearchScratch& scratch) noexcept;

}  // namespace ist
