#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/scenes.h"
#include "query/test_clocks.h"
#include "query/triangles/mesh_distance.h"
#include "simd/dispatch.h"
#include "simd/targets.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr Budget kNoEnd{};

FoundPairs ask_within(Query& query, const Eigen::Isometry3d& pose, const Budget& budget) {
  FoundPairs answer{{}, std::vector<LeafPair>(1 << 17)};
  answer.result = query.leaf_pairs(pose, answer.leaf_pairs, budget);
  EXPECT_FALSE(answer.result.truncated);
  answer.leaf_pairs.resize(answer.result.leaf_pairs);
  return answer;
}

bool same_known(const FoundPairs& a, const FoundPairs& b) {
  return same(a, b) && a.result.distance->lower == b.result.distance->lower &&
         a.result.distance->upper == b.result.distance->upper;
}

// A ball of radius 1 beside a block, and how far the true surfaces are apart.
struct Approach {
  double distance;
  Eigen::Isometry3d pose;
};
const TriangleMesh kBall = icosphere(3, 1), kBlock = box({-0.9, -0.7, -0.8}, {0.9, 0.7, 0.8});

std::vector<Approach> approaches() {
  std::vector<Approach> all;
  for (const double x : {0.0, 1.6, 1.85, 1.95, 2.0, 2.5, 40.0}) {
    Eigen::Isometry3d pose = solids()[0].pose;
    pose.translation() = Eigen::Vector3d(x, 0.1, -0.05);
    all.push_back({mesh_distance(kBall, kBlock, pose), pose});
  }
  return all;
}

class Within : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Targets, Within, ::testing::ValuesIn(all_targets()), name_of);

TEST_P(Within, ABudgetOfTestsTheAnswerIsTrueAndTheSameEverywhere) {
  int stopped = 0, apart = 0;
  for (const Approach& approach : approaches()) {
    for (const Scene& scene : solids()) {
      for (const SpherePolicy policy : kSpherePolicies) {
        Query query(scene.fixed, scene.moving, options_of(policy, GetParam()));
        Query scalar(scene.fixed, scene.moving, options_of(policy, "scalar"));
        DistanceInterval before{0, HUGE_VAL};
        int level = 100;
        for (const std::uint64_t tests : {0u, 1u, 2u, 30u, 400u, 3'000u, 50'000u, 10'000'000u}) {
          SCOPED_TRACE(std::string(to_string(policy)) + ", " + std::to_string(tests) + " tests, " +
                       std::to_string(approach.distance) + " apart");
          const FoundPairs answer = ask_within(query, approach.pose, {tests});
          const QueryResult& result = answer.result;
          EXPECT_TRUE(same_known(answer, ask_within(scalar, approach.pose, {tests})));
          EXPECT_LE(result.sphere_tests, std::max<std::uint64_t>(tests, 1));
          ASSERT_TRUE(result.distance.has_value());
          EXPECT_TRUE(std::isfinite(result.distance->upper));
          EXPECT_LE(result.distance->lower, approach.distance);
          EXPECT_GE(result.distance->upper, approach.distance);
          EXPECT_GE(result.distance->lower, before.lower);
          EXPECT_LE(result.distance->upper, before.upper);
          EXPECT_LE(result.level, level);
          EXPECT_EQ(result.complete, result.level == 0);
          before = *result.distance;
          level = result.level;
          stopped += result.complete ? 0 : 1;
          apart += result.distance->lower > 0 ? 1 : 0;
        }
        EXPECT_EQ(level, 0);
      }
    }
  }
  EXPECT_GT(stopped, 100);
  EXPECT_GT(apart, 50);
}

TEST_P(Within, ABudgetWithoutEndTheAnswerIsThatOfAllTests) {
  for (const Scene& scene : solids()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const std::size_t pairs : {65536u, 100u, 7u, 1u}) {
        QueryOptions options = options_of(policy, GetParam());
        options.frontier_pairs = pairs;
        Query query(scene.fixed, scene.moving, options);
        EXPECT_TRUE(same(ask_within(query, scene.pose, kNoEnd), ask(query, scene.pose)))
            << scene.name << ", " << to_string(policy) << ", " << pairs << " pairs";
      }
    }
  }
}

// What was found before is there: the first contacts, in order.
TEST(WithinABudget, ContactsAreTheFirst) {
  const Scene& scene = solids()[0];
  QueryOptions options = options_of(SpherePolicy::kSlab);
  options.frontier_pairs = 64;
  Query query(scene.fixed, scene.moving, options);
  const FoundPairs all = ask(query, scene.pose);
  std::size_t some = 0;
  for (std::uint64_t tests = 1; tests < all.result.sphere_tests; tests += 997) {
    const FoundPairs answer = ask_within(query, scene.pose, {tests});
    ASSERT_FALSE(answer.result.complete);
    ASSERT_LE(answer.leaf_pairs.size(), all.leaf_pairs.size());
    ASSERT_TRUE(
        std::equal(answer.leaf_pairs.begin(), answer.leaf_pairs.end(), all.leaf_pairs.begin()));
    some += answer.leaf_pairs.empty() ? 0U : 1U;
  }
  EXPECT_GT(some, 20u);
}

// Counts the tests and pairs from one look at the clock to the next.
struct Watched : PairLister {
  using PairLister::PairLister;
  Advanced advance(const SearchBatch& batch) noexcept {
    const std::uint64_t looks = FakeClock::looks;
    const Advanced made = PairLister::advance(batch);
    EXPECT_EQ(FakeClock::looks, looks + 1);
    most_tests = std::max(most_tests, made.tests);
    pairs = 0;
    return made;
  }
  bool leaves(const Frontier& leaf_pairs) noexcept {
    pairs += leaf_pairs.moving_count;
    most_pairs = std::max(most_pairs, pairs);
    return PairLister::leaves(leaf_pairs);
  }
  std::uint64_t most_tests = 0, pairs = 0, most_pairs = 0;
};

void expect_looks(const SphereTree& fixed, const SphereTree& moving, const Eigen::Isometry3d& at) {
  const SearchPlan plan(fixed, moving, SpherePolicy::kSlab);
  Search search(plan, select_kernels(""), 1 << 16);
  const auto relative = relative_pose(at, parts_of(fixed).origin, parts_of(moving).origin);
  const SearchPose pose = to_float(*relative, lengths_of(fixed, SpherePolicy::kSlab),
                                   lengths_of(moving, SpherePolicy::kSlab));
  std::vector<LeafPair> out(1 << 20), all_out(1 << 20);
  LeafPairSink sink(plan, select_kernels(""), out), all_sink(plan, select_kernels(""), all_out);
  const Budget budget{.deadline = Budget::Clock::time_point(std::chrono::seconds(1))};
  const ScopedBudgetClock clock(FakeClock::now);
  Watched watched(pose, sink, BudgetMeter(budget));
  EXPECT_EQ(search.run(watched), plan.steps().size());
  EXPECT_LE(watched.most_tests, 500u);  // as Budget states
  EXPECT_LE(watched.most_pairs, 512u);
  EXPECT_GT(watched.most_tests, 250u);
  EXPECT_GT(watched.most_pairs, 128u);
  PairLister all(pose, all_sink);
  search.run(all);
  EXPECT_EQ(all.tests(), watched.tests());
  ASSERT_EQ(all_sink.count(), sink.count());
  ASSERT_LE(sink.count(), out.size());
  out.resize(sink.count());  // elements behind the last pair may be overwritten
  all_out.resize(sink.count());
  EXPECT_EQ(all_out, out);
}

TEST(WithinADeadline, TheClockIsReadOftenEnough) {
  expect_looks(shells().fixed, shells().moving, shells().pose);
  // One leaf that all others touch.
  expect_looks(tree_of(box({-1, -1, -1}, {1, 1, 1}), 1), tree_of(icosphere(3, 1), 120),
               shift({0.1, 0, 0}));
}

TEST(WithinADeadline, TheSearchEndsAtTheFirstLookAfterIt) {
  const ScopedBudgetClock clock(LateClock::now);
  const Scene& scene = solids()[0];
  for (const SpherePolicy policy : kSpherePolicies) {
    Query query(scene.fixed, scene.moving, options_of(policy));
    std::uint64_t before = 0;
    for (int allowed = 0; allowed < 40; ++allowed) {
      const Budget budget = LateClock::budget_of(allowed);
      const FoundPairs stopped = ask_within(query, scene.pose, budget);
      EXPECT_FALSE(stopped.result.complete);
      EXPECT_EQ(LateClock::looks, allowed + 1);
      EXPECT_LE(stopped.result.sphere_tests, before + BudgetMeter::kUnwatchedTests + 1);
      EXPECT_TRUE(same_known(ask_within(query, scene.pose, {stopped.result.sphere_tests}), stopped))
          << allowed;
      before = stopped.result.sphere_tests;
    }
  }
}

TEST(WithinADeadline, ThatIsPastTheRootsAreKnown) {
  const Scene& scene = solids()[0];
  Query query(scene.fixed, scene.moving, options_of(SpherePolicy::kSlab));
  const FoundPairs answer = ask_within(query, scene.pose, {.deadline = Budget::Clock::now()});
  EXPECT_FALSE(answer.result.complete);
  EXPECT_EQ(answer.result.sphere_tests, 1u);
  EXPECT_EQ(answer.result.level, std::max(scene.fixed.depth(), scene.moving.depth()));
  EXPECT_EQ(answer.result.distance->lower, 0);
  EXPECT_LT(answer.result.distance->upper, 20);
}

TEST(WithinADeadline, ThatIsFarAllIsKnown) {
  const Scene& scene = solids()[0];
  Query query(scene.fixed, scene.moving, options_of(SpherePolicy::kSlab));
  const Budget hour{.deadline = Budget::Clock::now() + std::chrono::hours(1)};
  EXPECT_TRUE(same(ask_within(query, scene.pose, hour), ask(query, scene.pose)));
}

TEST(BudgetMeter, AllowsWhatIsLeft) {
  EXPECT_EQ(BudgetMeter().allow(), std::numeric_limits<std::uint64_t>::max());
  BudgetMeter meter({.tests = 1000}, 100);
  EXPECT_EQ(meter.allow(), 900u);
  meter.spend(899);
  EXPECT_EQ(meter.allow(), 1u);
  meter.spend(1);
  EXPECT_EQ(meter.allow(), 0u);
  EXPECT_EQ(meter.spent(), 1000u);
  const auto start = Budget::Clock::now();
  EXPECT_EQ(BudgetMeter({.deadline = start}).allow(), 0u);
  EXPECT_EQ(BudgetMeter({.deadline = start + std::chrono::hours(1)}).allow(),
            BudgetMeter::kUnwatchedTests);
  EXPECT_EQ(BudgetMeter({.tests = 7, .deadline = start + std::chrono::hours(1)}).allow(), 7u);
}

TEST(BudgetMeter, LeavesABudgetOfTheRest) {
  const auto deadline = Budget::Clock::time_point(std::chrono::seconds(1));
  BudgetMeter meter({.tests = 1000, .deadline = deadline}, 100);
  EXPECT_EQ(meter.rest().tests, 900u);
  EXPECT_EQ(meter.rest().deadline, deadline);
  meter.spend(2000);
  EXPECT_EQ(meter.rest().tests, 0u);
  EXPECT_FALSE(BudgetMeter({}, 100).rest().is_limited());
  EXPECT_EQ(Budget{.tests = 7}.within(9).tests, 7u);
  EXPECT_EQ(Budget{}.within(9).tests, 9u);
}

TEST(BudgetMeter, WithoutLimitsAllowsAllAndReadsNoClock) {
  FakeClock::looks = 0;
  const ScopedBudgetClock clock(FakeClock::now);
  BudgetMeter meter(Budget{});
  EXPECT_FALSE(meter.is_limited());
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(meter.allows(1'000'000'000));
    meter.spend(1'000'000'000);
  }
  EXPECT_EQ(FakeClock::looks, 0u);
}

TEST(BudgetMeter, OfTestsAllowsNoMore) {
  BudgetMeter meter({.tests = 100}, 10);
  EXPECT_TRUE(meter.allows(90));
  EXPECT_FALSE(meter.allows(91));
  meter.spend(90);
  EXPECT_TRUE(meter.allows(0));
  EXPECT_FALSE(meter.allows(1));
  EXPECT_EQ(meter.spent(), 100u);
}

TEST(BudgetMeter, OfTimeReadsTheClockAtLeastEvery500Tests) {
  const ScopedBudgetClock clock(LateClock::now);
  BudgetMeter meter(LateClock::budget_of(3));
  std::uint64_t unwatched = 0;
  while (meter.allows(16)) {
    meter.spend(16);
    unwatched += 16;
    ASSERT_LE(unwatched,
              (static_cast<std::uint64_t>(LateClock::looks) + 1) * BudgetMeter::kUnwatchedTests);
  }
  EXPECT_EQ(LateClock::looks, 4);
}

TEST(BudgetMeter, HasOneRuleForTheClock) {
  FakeClock::looks = 0;
  const ScopedBudgetClock clock(FakeClock::now);
  BudgetMeter meter({.deadline = Budget::Clock::time_point(std::chrono::seconds(1))});
  EXPECT_EQ(meter.allow(), 500u);
  EXPECT_EQ(FakeClock::looks, 1u);
  meter.spend(300);
  EXPECT_TRUE(meter.allows(199));
  EXPECT_EQ(FakeClock::looks, 1u);
  EXPECT_TRUE(meter.allows(200));
  EXPECT_EQ(FakeClock::looks, 2u);
}

TEST(WithinABudget, AnInvalidPoseIsAStatus) {
  const Scene& scene = solids()[0];
  Query query(scene.fixed, scene.moving, options_of(SpherePolicy::kTable));
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.matrix()(3, 3) = 2;
  EXPECT_EQ(query.leaf_pairs(bad, {}, kNoEnd).status, QueryStatus::kInvalidPose);
}

}  // namespace
}  // namespace ist::test
