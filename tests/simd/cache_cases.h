#pragma once

#include <cstdint>
#include <memory>

#include "simd/guarded_cache.h"
#include "simd/lanes.h"
#include "simd/plan_cases.h"
#include "simd/terms_recorder.h"

namespace ist::test {

/// Room for all that the tests put into a cache.
inline constexpr std::size_t kRoomy = 1 << 15;

/// The pairs before the last step, from the roots down by the scalar form.
[[nodiscard]] inline std::unique_ptr<GuardedFrontier> before_last(const PlannedSearch& search,
                                                                  const SearchPose& pose,
                                                                  SearchScratch& scratch) {
  auto in = std::make_unique<GuardedFrontier>(1, 0);
  in->append(0, std::vector<std::uint32_t>{0});
  for (std::size_t step = 0; step + 1 < search.plan.steps().size(); ++step) {
    auto out = std::make_unique<GuardedFrontier>(search.plan.most_pairs(step), 0);
    SearchCursor cursor;
    DistanceBounds none;
    advance_scalar(search.plan.steps()[step], pose, *in, cursor, *out, scratch, ~std::uint64_t{0},
                   Measured::kNothing, none);
    in = std::move(out);
  }
  return in;
}

}  // namespace ist::test
