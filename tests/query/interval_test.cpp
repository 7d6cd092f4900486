// The interval that a stopped search tells, against the formula of docs/guarantees.md, computed
// from the list of all pairs that are pruned or live where the search stopped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "ist/query/manifold.h"
#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/scenes.h"
#include "simd/lanes.h"

namespace ist::test {
namespace {

// The distances that the bounds of a pair allow, mesh units, in double; without the pads for
// rounding, but slabs of inner nodes count as wider for large partners.
struct Distances {
  double least, greatest;
};

Distances distances_of(const PairTest& test, const Pads& rounding, bool slabs) {
  const double distance = std::sqrt(double{test.squared});
  const double radii = double{test.radius_sum} - rounding.ball;
  Distances distances{distance - radii, distance + radii};
  if (slabs) {
    const double fixed = double{test.over_fixed} - (double{test.fixed_sum} - rounding.slab_fixed);
    const double moving =
        (double{test.over_moving} - double{test.moving_sum}) / kSlabScale + rounding.slab_moving;
    distances.least = std::max({distances.least, fixed, moving});
  }
  return distances;
}

// The pads of inner nodes without a slab's rise: in proportion to those of leaves, as derived.
Pads rounding_of(const SearchPose& pose) {
  const float slab = pose.leaf.slab_fixed * (53.0F / 17);
  return {pose.inner.ball, slab, slab};
}

// Lists pairs, and keeps its own list of all pairs that are pruned, and of those that are live: an
// overlapping pair is live until all its children are tested.
class Listing : public PairLister {
 public:
  Listing(const SearchPose& pose, LeafPairSink& sink, const BudgetMeter& meter)
      : PairLister(pose, sink, meter, Measured::kBoth), pose_(pose), inner_(rounding_of(pose)) {}

  Advanced advance(const SearchBatch& batch) noexcept {
    SearchCursor from = batch.cursor;
    const Advanced made = PairLister::advance(batch);
    const bool slabs = batch.step.fixed.slabs != nullptr;
    std::uint64_t tests = 0;
    for (; tests < made.tests; ++from.group, from.row = from.moving = 0) {
      const SearchGroup group = batch.in.groups[from.group];
      const std::uint32_t begin = from.group == 0 ? 0 : batch.in.groups[from.group - 1].end;
      const std::uint32_t rows = decode(batch.step.fixed, group.fixed, scratch_->fixed[0].lanes, 0);
      for (; from.row < rows && tests < made.tests; ++from.row, from.moving = 0) {
        turn(pose_, pads_of(pose_, batch.step), slabs, scratch_->fixed[0].lanes, from.row,
             scratch_->fixed[0].rows);
        for (std::uint32_t i = begin + from.moving; i < group.end && tests < made.tests; ++i) {
          const std::uint32_t lanes =
              decode(batch.step.moving, batch.in.moving[i], scratch_->moving, 0);
          for (std::uint32_t at = 0; at < lanes; ++at) {
            const PairTest test(scratch_->fixed[0].rows, from.row, scratch_->moving, at, slabs);
            const Distances distances =
                distances_of(test, batch.step.leaves ? pose_.leaf : inner_, slabs);
            (test.overlap() ? live_ : pruned_).push_back(distances);
          }
          tests += lanes;
        }
      }
    }
    EXPECT_EQ(tests, made.tests);
    return made;
  }

  // With a step that is whole, the pairs before it are live no more.
  bool enter(std::size_t /*step*/, const Frontier& pairs, bool whole) noexcept {
    EXPECT_TRUE(whole);
    keep_last(pairs.moving_count);
    return true;
  }
  void keep_last(std::size_t pairs) {
    live_.erase(live_.begin(), live_.end() - static_cast<std::ptrdiff_t>(pairs));
  }

  [[nodiscard]] DistanceInterval formula(double pad) const {
    DistanceInterval interval{HUGE_VAL, HUGE_VAL};
    for (const auto* pairs : {&live_, &pruned_}) {
      for (const Distances& d : *pairs) interval.lower = std::min(interval.lower, d.least);
    }
    for (const Distances& d : live_.empty() ? pruned_ : live_) {
      interval.upper = std::min(interval.upper, d.greatest);
    }
    return {std::max(0.0, interval.lower - pad), interval.upper + pad};
  }

 private:
  const SearchPose& pose_;
  Pads inner_;
  std::unique_ptr<SearchScratch> scratch_ = std::make_unique<SearchScratch>();
  std::vector<Distances> live_{{-HUGE_VAL, HUGE_VAL}};  // first the pair of roots
  std::vector<Distances> pruned_;
};

TEST(StoppedSearch, TellsNoWiderIntervalThanTheFormula) {
  int stopped = 0, apart = 0;
  for (const Scene& scene : solids()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      const SearchPlan plan(scene.fixed, scene.moving, policy);
      const Kernels& kernels = select_kernels("");
      Search search(plan, kernels, 1 << 20);
      Query query(scene.fixed, scene.moving, options_of(policy));
      ContactManifold contacts(scene.fixed, scene.moving, policy);
      for (const double x : {0.0, 1.6, 1.9, 2.1, 2.6}) {
        Eigen::Isometry3d at = scene.pose;
        at.translation()[0] += x;
        for (const std::uint64_t tests : {1u, 9u, 100u, 900u, 7'000u, 40'000u, 10'000'000u}) {
          SCOPED_TRACE(scene.name + ", " + std::string(to_string(policy)) + ", " +
                       std::to_string(x) + ", " + std::to_string(tests) + " tests");
          const QueryResult told =
              query.leaf_pairs(at, std::span<LeafPair>(), {.tests = tests + 1});
          if (told.sphere_tests == 1) continue;  // the roots are apart, or no test was left
          const SearchPose pose = to_float(
              *relative_pose(at, scene.fixed.parts().lattice, scene.moving.parts().lattice),
              lengths_of(scene.fixed, policy), lengths_of(scene.moving, policy));
          LeafPairSink sink(plan, kernels, {});
          Listing listing(pose, sink, BudgetMeter({.tests = tests}));
          const std::size_t steps = search.run(listing);
          if (steps == plan.steps().size()) listing.keep_last(sink.count());
          EXPECT_EQ(listing.tests() + 1, told.sphere_tests);
          EXPECT_EQ(static_cast<int>(plan.steps().size() - steps), told.level);
          EXPECT_EQ(told.complete, told.level == 0);
          const Pads pads = rounding_of(pose);  // no less than those of leaves
          const DistanceInterval formula =
              listing.formula(std::max({pads.ball, pads.slab_fixed, pads.slab_moving}));
          const double last_bits = 1e-6 * formula.upper;
          EXPECT_GE(told.distance->lower, formula.lower - last_bits);
          EXPECT_LE(told.distance->upper, formula.upper + last_bits);
          const QueryResult weighed = query.contacts(at, contacts, {.tests = tests + 1});
          EXPECT_EQ(weighed.sphere_tests, told.sphere_tests);
          EXPECT_EQ(weighed.level, told.level);
          if (!weighed.complete) {
            EXPECT_GE(weighed.distance->lower, formula.lower - last_bits);
            EXPECT_LE(weighed.distance->upper, formula.upper + last_bits);
          }
          stopped += told.complete ? 0 : 1;
          apart += formula.lower > 0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(stopped, 100);
  EXPECT_GT(apart, 10);
}

}  // namespace
}  // namespace ist::test
