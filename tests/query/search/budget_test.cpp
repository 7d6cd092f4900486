#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ist/query/kernels.h"
#include "ist/query/relative_pose.h"
#include "ist/query/search.h"
#include "ist/query/search_pose.h"
#include "query/exact/mesh_distance.h"
#include "query/search/scenes.h"
#include "query/search/targets.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr Budget kNoEnd{};

Answer ask_within(CollisionQuery& query, const Eigen::Isometry3d& pose, const Budget& budget) {
  Answer answer{{}, std::vector<Contact>(1 << 17)};
  answer.result = query.collide(pose, answer.contacts, budget);
  EXPECT_FALSE(answer.result.truncated);
  answer.contacts.resize(answer.result.contacts);
  return answer;
}

bool same_known(const Answer& a, const Answer& b) {
  return same(a, b) && a.result.gap->lower == b.result.gap->lower &&
         a.result.gap->upper == b.result.gap->upper;
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
        CollisionQuery query(scene.fixed, scene.moving, options_of(policy, GetParam()));
        CollisionQuery scalar(scene.fixed, scene.moving, options_of(policy, "scalar"));
        GapInterval before{0, HUGE_VAL};
        int level = 100;
        for (const std::uint64_t tests : {0u, 1u, 2u, 30u, 400u, 3'000u, 50'000u, 10'000'000u}) {
          SCOPED_TRACE(std::string(to_string(policy)) + ", " + std::to_string(tests) + " tests, " +
                       std::to_string(approach.distance) + " apart");
          const Answer answer = ask_within(query, approach.pose, {tests});
          const QueryResult& result = answer.result;
          EXPECT_TRUE(same_known(answer, ask_within(scalar, approach.pose, {tests})));
          EXPECT_LE(result.sphere_tests, std::max<std::uint64_t>(tests, 1));
          ASSERT_TRUE(result.gap.has_value());
          EXPECT_TRUE(std::isfinite(result.gap->upper));
          EXPECT_LE(result.gap->lower, approach.distance);
          EXPECT_GE(result.gap->upper, approach.distance);
          EXPECT_GE(result.gap->lower, before.lower);
          EXPECT_LE(result.gap->upper, before.upper);
          EXPECT_LE(result.level, level);
          EXPECT_EQ(result.complete, result.level == 0);
          before = *result.gap;
          level = result.level;
          stopped += result.complete ? 0 : 1;
          apart += result.gap->lower > 0 ? 1 : 0;
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
        CollisionOptions options = options_of(policy, GetParam());
        options.frontier_pairs = pairs;
        CollisionQuery query(scene.fixed, scene.moving, options);
        EXPECT_TRUE(same(ask_within(query, scene.pose, kNoEnd), ask(query, scene.pose)))
            << scene.name << ", " << to_string(policy) << ", " << pairs << " pairs";
      }
    }
  }
}

// What was found before is there: the first contacts, in order.
TEST(WithinABudget, ContactsAreTheFirst) {
  const Scene& scene = solids()[0];
  CollisionOptions options = options_of(SpherePolicy::kSlab);
  options.frontier_pairs = 64;
  CollisionQuery query(scene.fixed, scene.moving, options);
  const Answer all = ask(query, scene.pose);
  std::size_t some = 0;
  for (std::uint64_t tests = 1; tests < all.result.sphere_tests; tests += 997) {
    const Answer answer = ask_within(query, scene.pose, {tests});
    ASSERT_FALSE(answer.result.complete);
    ASSERT_LE(answer.contacts.size(), all.contacts.size());
    ASSERT_TRUE(std::equal(answer.contacts.begin(), answer.contacts.end(), all.contacts.begin()));
    some += answer.contacts.empty() ? 0U : 1U;
  }
  EXPECT_GT(some, 20u);
}

// Else many of them would be handed over after the time is over: 30 µs for 60,000.
void expect_few_at_a_time(const SphereTree& fixed, const SphereTree& moving,
                          const Eigen::Isometry3d& at) {
  struct Taken final : ContactStream {
    bool take(std::span<const Contact> some) noexcept override {
      most = std::max(most, some.size());
      contacts.insert(contacts.end(), some.begin(), some.end());
      return true;
    }
    std::size_t most = 0;
    std::vector<Contact> contacts;
  } taken, all_taken;
  const SearchPlan plan(fixed, moving, SpherePolicy::kSlab);
  Search search(plan, find_kernels(""), 1 << 16);
  const auto relative = relative_pose(at, fixed.lattice(), moving.lattice());
  const SearchPose pose = narrow(*relative, fixed.reach() + moving.reach(), 0);
  std::vector<Contact> window(1 << 17);
  ContactSink sink(window, taken), all(window, all_taken);
  const Search::Known known = search.run_within(kNoEnd, pose, sink);
  EXPECT_GT(taken.contacts.size(), 4 * Search::kLeavesAtOnce);
  EXPECT_LE(taken.most, Search::kLeavesAtOnce);
  EXPECT_EQ(search.run(pose, all), known.tests);  // what follows is as it was
  EXPECT_EQ(all_taken.contacts, taken.contacts);
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
  CollisionQuery query(scene.fixed, scene.moving, options_of(SpherePolicy::kSlab));
  const Answer answer = ask_within(query, scene.pose, {.deadline = Budget::Clock::now()});
  EXPECT_FALSE(answer.result.complete);
  EXPECT_EQ(answer.result.sphere_tests, 1u);
  EXPECT_EQ(answer.result.level, std::max(scene.fixed.depth(), scene.moving.depth()));
  EXPECT_EQ(answer.result.gap->lower, 0);
  EXPECT_LT(answer.result.gap->upper, 20);
}

TEST(WithinADeadline, ThatIsFarAllIsKnown) {
  const Scene& scene = solids()[0];
  CollisionQuery query(scene.fixed, scene.moving, options_of(SpherePolicy::kSlab));
  const Budget hour{.deadline = Budget::Clock::now() + std::chrono::hours(1)};
  EXPECT_TRUE(same(ask_within(query, scene.pose, hour), ask(query, scene.pose)));
}

TEST(Spending, LooksAtTheClockOftenEnoughAndStaysWithinItsTests) {
  Spending spending({.sphere_tests = 1000});
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
  CollisionQuery query(scene.fixed, scene.moving, options_of(SpherePolicy::kTable));
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.matrix()(3, 3) = 2;
  EXPECT_EQ(query.collide(bad, {}, kNoEnd).status, QueryStatus::kInvalidPose);
}

}  // namespace
}  // namespace ist::test
