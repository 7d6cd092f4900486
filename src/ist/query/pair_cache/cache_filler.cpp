#include "ist/query/pair_cache/cache_filler.h"

#include <algorithm>

namespace ist {
namespace {

// Keeps all leaf pairs, until there is no room.
class Keeper : public VisitorBase {
 public:
  Keeper(const SearchPose& pose, Measured measured, PairCache& cache, DistanceBounds& bounds,
         const BudgetMeter& meter) noexcept
      : pose_(pose), measured_(measured), cache_(cache), bounds_(bounds), meter_(meter) {}

  Advanced advance(const SearchBatch& batch) noexcept {
    const std::uint64_t most = meter_.allow();
    const Advanced made =
        batch.step.last ? batch.kernels.advance_cache(batch.step, pose_, batch.in, batch.cursor,
                                                      cache_.lanes, batch.scratch, most)
                        : batch.measure(measured_, pose_, bounds_, most);
    meter_.spend(made.tests);
    full_ = batch.step.last && made.full;
    return full_ ? Advanced{0, false} : made;  // a search ends if no test is made
  }
  static bool leaves(const Frontier& /*none*/) noexcept { return true; }

  [[nodiscard]] bool full() const noexcept { return full_; }
  [[nodiscard]] std::uint64_t tests() const noexcept { return meter_.spent(); }

 private:
  const SearchPose& pose_;
  Measured measured_;
  PairCache& cache_;
  DistanceBounds& bounds_;
  BudgetMeter meter_;
  bool full_ = false;
};

}  // namespace

void CacheFiller::begin(PairCache& cache, const Wanted& wanted) noexcept {
  cache_ = &cache;
  wanted_ = wanted;
  cache.lanes.pair_count = cache.lanes.row_count = 0;
  cache.centre = wanted.centre;
  cache.extent = wanted.extent;
  bounds_ = {};
  tests_ = 0;
  position_ = search_.roots();
  full_ = false;
}

void CacheFiller::advance(const Budget& budget) noexcept {
  if (is_whole() || full_) return;
  const std::uint64_t left = wanted_.most_tests - std::min(wanted_.most_tests, tests_);
  Keeper keeper(wanted_.pose, wanted_.measured, *cache_, bounds_, BudgetMeter(budget.within(left)));
  position_ = search_.resume(position_, keeper);
  tests_ += keeper.tests();
  if (is_whole()) {
    cache_->upper = bounds_.upper - wanted_.extent;  // the radii were inflated by the extent
  } else {
    full_ = keeper.full() || (budget.tests >= left && !budget.is_past());
  }
}

}  // namespace ist
