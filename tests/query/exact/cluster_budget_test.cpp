#include "ist/query/exact/cluster_budget.h"

#include <gtest/gtest.h>

namespace ist::test {
namespace {

int looks;
Budget::Clock::time_point counting() noexcept {
  ++looks;
  return Budget::Clock::time_point(std::chrono::seconds(looks));
}

TEST(ClusterBudget, WithoutLimitsAllowsAllAndReadsNoClock) {
  looks = 0;
  ClusterBudget budget({.now = counting}, 0);
  EXPECT_FALSE(budget.is_limited());
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(budget.allows(1'000'000'000));
    budget.spend(1'000'000'000);
  }
  EXPECT_EQ(looks, 0);
}

TEST(ClusterBudget, OfTestsAllowsNoMore) {
  ClusterBudget budget({.tests = 100}, 10);
  EXPECT_TRUE(budget.allows(90));
  EXPECT_FALSE(budget.allows(91));
  budget.spend(90);
  EXPECT_TRUE(budget.allows(0));
  EXPECT_FALSE(budget.allows(1));
  EXPECT_EQ(budget.spent(), 100u);
}

TEST(ClusterBudget, OfTimeReadsTheClockAsOftenAsItSays) {
  looks = 0;
  ClusterBudget budget(
      {.deadline = Budget::Clock::time_point(std::chrono::seconds(4)), .now = counting}, 0);
  std::uint64_t unwatched = 0;
  while (budget.allows(16)) {
    budget.spend(16);
    unwatched += 16;
    ASSERT_LE(unwatched, (static_cast<std::uint64_t>(looks) + 1) * ClusterBudget::kUnwatchedTests);
  }
  EXPECT_EQ(looks, 4);
}

}  // namespace
}  // namespace ist::test
