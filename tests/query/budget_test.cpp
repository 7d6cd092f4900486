#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/exact/mesh_distance.h"
#include "query/scenes.h"
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

// Else many of them would be handed over after the time is over: 30 µs for 60,000.
void expect_few_at_a_time(const SphereTree& fixed, const SphereTree& moving,
                          const Eigen::Isometry3d& at) {
  struct Taken final : LeafPairStream {
    bool take(std::span<const LeafPair> some) noexcept override {
      most = std::max(most, some.size());
      leaf_pairs.insert(leaf_pairs.end(), some.begin(), some.end());
      return true;
    }
    std::size_t most = 0;
    std::vector<LeafPair> leaf_pairs;
  } taken, all_taken;
  const SearchPlan plan(fixed, moving, SpherePolicy::kSlab);
  Search search(plan, select_kernels(""), 1 << 16);
  const auto relative = relative_pose(at, fixed.parts().lattice, moving.parts().lattice);
  const SearchPose pose =
      to_float(*relative, fixed.bounding_radius() + moving.bounding_radius(), 0);
  std::vector<LeafPair> window(1 << 17);
  LeafPairSink sink(window, taken), all(window, all_taken);
  const Search::AnytimeResult known = search.run_within(kNoEnd, pose, sink);
  EXPECT_GT(taken.leaf_pairs.size(), 4 * Search::kLeavesAtOnce);
  EXPECT_LE(taken.most, Search::kLeavesAtOnce);
  EXPECT_EQ(search.run(pose, all), known.tests);  // what follows is as it was
  EXPECT_EQ(all_taken.leaf_pairs, taken.leaf_pairs);
  EXPECT_GT(all_taken.most, Search::kLeavesAtOnce);
}

TEST(WithinABudget, ContactsAreHandedOverFewAtATime) {
  expect_few_at_a_time(shells().fixed, shells().moving, shells().pose);
  // One leaf that all others touch.
  expect_few_at_a_time(tree_of(box({-1, -1, -1}, {1, 1, 1}), 1), tree_of(icosphere(3, 1), 120),
                       shift({0.1, 0, 0}));
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

TEST(Spending, LooksAtTheClockOftenEnoughAndStaysWithinItsTests) {
  Spending spending({.tests = 1000});
  EXPECT_TRUE(spending.spend(500));
  EXPECT_TRUE(spending.spend(499));
  EXPECT_FALSE(spending.spend(2));
  EXPECT_FALSE(spending.spend(1));  // nothing more once it is over
  EXPECT_EQ(spending.tests(), 999u);
  Spending late({.deadline = Budget::Clock::now()});
  EXPECT_FALSE(late.spend(0));
  Spending soon({.deadline = Budget::Clock::now() + std::chrono::milliseconds(20)});
  int times = 0;
  while (soon.spend(Spending::kUnwatched)) ++times;
  EXPECT_GT(times, 100);
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
