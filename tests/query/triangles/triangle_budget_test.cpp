#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "ist/query/query.h"
#include "query/test_clocks.h"
#include "query/triangles/triangle_tree.h"
#include "simd/targets.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// Some budgets of tests, from none at all to more than any search here takes.
constexpr std::uint64_t kBudgets[] = {0,    1,    2,      40,     300,     1000,
                                      3000, 8000, 20'000, 60'000, 200'000, 10'000'000};

Budget tests(std::uint64_t most) {
  Budget budget;
  budget.tests = most;
  return budget;
}

std::uint64_t allowed(std::uint64_t most) { return std::max<std::uint64_t>(most, 1); }

// Two balls that cross, that are apart, and a ring of few triangles round one of them.
class TriangleBudget : public ::testing::Test {
 protected:
  const SphereTree fixed_ = triangle_tree(icosphere(4, 1), 12);
  const SphereTree moving_ = triangle_tree(icosphere(4, 0.8), 12);
  const Eigen::Isometry3d meeting_ = shift({0.7, 0.1, 0}), apart_ = shift({1.95, 0.3, 0});
};

TEST_F(TriangleBudget, OfTestsEndsIntersectsInDoubtAndNeverInError) {
  for (const std::string& target : all_targets()) {
    Query query(fixed_, moving_, {.target = target});
    bool undecided = false, decided = false;
    for (const std::uint64_t most : kBudgets) {
      for (const bool meets : {false, true}) {
        const IntersectionResult found = query.intersects(meets ? meeting_ : apart_, tests(most));
        EXPECT_LE(found.sphere_tests, allowed(most));
        (found.complete ? decided : undecided) = true;
        EXPECT_EQ(found.answer, !found.complete ? Answer::kUnknown
                                : meets         ? Answer::kYes
                                                : Answer::kNo);
      }
    }
    EXPECT_TRUE(undecided && decided);
  }
}

TEST_F(TriangleBudget, OfTestsGivesSomeOfThePairs) {
  std::vector<TrianglePair> all(1 << 14), some = all;
  Query whole(fixed_, moving_);
  const TrianglePairsResult truth = whole.triangle_pairs(meeting_, all);
  ASSERT_FALSE(truth.truncated);
  EXPECT_TRUE(truth.complete);
  all.resize(truth.triangle_pairs);
  ASSERT_GT(all.size(), 100u);
  std::vector<TrianglePairsResult> wanted;
  for (const std::string& target : all_targets()) {
    Query query(fixed_, moving_, {.target = target});
    std::size_t at = 0;
    for (const std::uint64_t most : kBudgets) {
      const TrianglePairsResult found = query.triangle_pairs(meeting_, some, tests(most));
      EXPECT_LE(found.sphere_tests, allowed(most));
      const auto last = some.begin() + static_cast<std::ptrdiff_t>(found.triangle_pairs);
      EXPECT_TRUE(std::includes(all.begin(), all.end(), some.begin(), last));
      EXPECT_EQ(found.complete, found.sphere_tests == truth.sphere_tests);
      EXPECT_EQ(found.complete, found.triangle_pairs == all.size());
      if (wanted.size() <= at) wanted.push_back(found);
      EXPECT_EQ(found.triangle_pairs, wanted[at].triangle_pairs) << target;
      EXPECT_EQ(found.sphere_tests, wanted[at].sphere_tests) << target;
      ++at;
    }
  }
  EXPECT_FALSE(wanted.front().complete);
  EXPECT_TRUE(wanted.back().complete);
}

TEST_F(TriangleBudget, OfTestsLeavesAnIntervalThatHoldsTheDistance) {
  for (const bool triangles : {false, true}) {
    const SphereTree fixed = triangles ? fixed_ : without_triangles(fixed_);
    const SphereTree moving = triangles ? moving_ : without_triangles(moving_);
    Query exact(fixed_, moving_);
    const DistanceInterval truth = exact.distance(apart_, 0).distance;
    std::vector<DistanceInterval> wanted;
    for (const std::string& target : all_targets()) {
      Query query(fixed, moving, {.target = target});
      std::size_t at = 0;
      for (const std::uint64_t most : kBudgets) {
        const DistanceResult found = query.distance(apart_, 0.01, tests(most));
        EXPECT_LE(found.sphere_tests, allowed(most));
        EXPECT_LE(found.distance.lower, truth.lower);
        EXPECT_GE(found.distance.upper, truth.upper);
        EXPECT_EQ(found.complete, found.distance.upper - found.distance.lower <= 0.01);
        if (wanted.size() <= at) wanted.push_back(found.distance);
        EXPECT_EQ(found.distance.lower, wanted[at].lower) << target << ' ' << most;
        EXPECT_EQ(found.distance.upper, wanted[at].upper) << target << ' ' << most;
        ++at;
      }
      EXPECT_EQ(query.distance(apart_, 0.01, tests(10'000'000)).complete, triangles);
    }
    EXPECT_GT(wanted.front().upper - wanted.front().lower,
              wanted.back().upper - wanted.back().lower);
  }
}

int glances, glances_left;
Budget::Clock::time_point late_at_last() noexcept {
  ++glances;
  return Budget::Clock::time_point(std::chrono::seconds(glances > glances_left ? 2 : 0));
}

// A deadline after any number of looks at the clock: often enough, and no answer is wrong.
TEST_F(TriangleBudget, OfTimeIsLookedAtOftenEnough) {
  Query query(fixed_, moving_), fresh(fixed_, moving_);
  const DistanceInterval truth = fresh.distance(apart_, 0).distance;
  std::vector<TrianglePair> pairs(1 << 14);
  const std::uint64_t all = fresh.triangle_pairs(meeting_, pairs).triangle_pairs;
  Budget budget;
  budget.deadline = Budget::Clock::time_point(std::chrono::seconds(1));
  const ScopedBudgetClock clock(late_at_last);
  for (glances_left = 0; glances_left < 40; ++glances_left) {
    query.forget();
    glances = 0;
    const IntersectionResult met = query.intersects(meeting_, budget);
    EXPECT_EQ(met.answer, met.complete ? Answer::kYes : Answer::kUnknown);
    EXPECT_LE(met.sphere_tests, 500 * (static_cast<std::uint64_t>(glances) + 1));
    glances = 0;
    query.forget();
    const TrianglePairsResult some = query.triangle_pairs(meeting_, pairs, budget);
    EXPECT_LE(some.triangle_pairs, all);
    EXPECT_EQ(some.complete, some.triangle_pairs == all);
    EXPECT_LE(some.sphere_tests, 500 * (static_cast<std::uint64_t>(glances) + 1));
    glances = 0;
    query.forget();
    const DistanceResult gap = query.distance(apart_, 0.01, budget);
    EXPECT_LE(gap.distance.lower, truth.lower);
    EXPECT_GE(gap.distance.upper, truth.upper);
    EXPECT_LE(gap.sphere_tests, 500 * (static_cast<std::uint64_t>(glances) + 1));
  }
}

// Of bodies that lie on each other float decides nothing: each pair is decided exactly.
TEST_F(TriangleBudget, OfTimeEndsExactArithmetic) {
  Query query(fixed_, fixed_);
  std::vector<TrianglePair> pairs(1 << 17);
  const Eigen::Isometry3d in_place = Eigen::Isometry3d::Identity();
  const std::uint64_t all = query.triangle_pairs(in_place, pairs).triangle_pairs;
  ASSERT_GT(all, 10'000u);
  Budget budget;
  budget.deadline = Budget::Clock::time_point(std::chrono::seconds(1));
  const ScopedBudgetClock clock(late_at_last);
  std::uint64_t most = 0;
  for (glances_left = 0; glances_left < 2000; glances_left += 97) {
    glances = 0;
    const TrianglePairsResult some = query.triangle_pairs(in_place, pairs, budget);
    EXPECT_LE(some.triangle_pairs, 8 * (static_cast<std::uint64_t>(glances) + 1));
    EXPECT_FALSE(some.complete);
    most = std::max(most, some.triangle_pairs);
  }
  EXPECT_GT(most, 0u);
  EXPECT_LT(most, all);
}

}  // namespace
}  // namespace ist::test
