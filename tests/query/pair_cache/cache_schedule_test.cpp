// The rules by which a cache is made: when it is worth its search, and how wide it is to be.

#include "ist/query/pair_cache/cache_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ist::test {
namespace {

constexpr double kVoxel = 0.2;
constexpr double kFar = 1e3;

TEST(CacheSchedule, ASlackLastsForManyTicksAndIsNeitherThinNorWide) {
  const CacheSchedule schedule(kVoxel, false);
  EXPECT_DOUBLE_EQ(schedule.slack({0, 0, 0}), 0.05 * kVoxel);
  EXPECT_DOUBLE_EQ(schedule.slack({0.002, 0.002, 0}), 0.04);
  EXPECT_DOUBLE_EQ(schedule.slack({0.005, 0, 0}), 0.02);  // it trembles
  EXPECT_DOUBLE_EQ(schedule.slack({0.1, 0.1, 0}), 0.4 * kVoxel);
}

// One worker makes a cache up to 0.1 voxel of motion a tick, two up to 0.2.
TEST(CacheSchedule, AFastBodyIsSearchedAnew) {
  for (const bool helped : {false, true}) {
    const CacheSchedule schedule(kVoxel, helped);
    const double most = (helped ? 0.2 : 0.1) * kVoxel;
    for (const double speed : {0.5 * most, 0.99 * most, 1.01 * most, 2 * most}) {
      EXPECT_EQ(schedule.is_worth(schedule.slack({speed, speed, 0}), speed), speed < most) << speed;
    }
    EXPECT_TRUE(schedule.is_worth_at_once(schedule.slack_at_once(), 0.1 * most));
    EXPECT_FALSE(schedule.is_worth_at_once(schedule.slack_at_once(), most));
  }
}

TEST(CacheSchedule, ACacheIsCentredWhereABodyGoesUnlessItTrembles) {
  EXPECT_DOUBLE_EQ(CacheSchedule::ticks_to_centre(0.08, {0.01, 0.01, 0}), 8);
  EXPECT_DOUBLE_EQ(CacheSchedule::ticks_to_centre(0.08, {0.001, 0.001, 0}), 20);
  EXPECT_EQ(CacheSchedule::ticks_to_centre(0.08, {0.01, 0.004, 0}), 0);
  EXPECT_EQ(CacheSchedule::ticks_to_centre(0.08, {0, 0, 0}), 0);
}

// Two fifths of the way to its centre before a cache is used up, and four ticks at least; where
// nothing tells where the body goes, when a fourth of the slack is left.
TEST(CacheSchedule, TheNextCacheIsBegunAhead) {
  for (const double drift : {0.001, 0.005, 0.01}) {
    const Pace steady{drift, drift, drift}, directed{drift, drift, 0.4 * drift},
        trembling{drift, 0.4 * drift, 0.4 * drift};
    EXPECT_DOUBLE_EQ(CacheSchedule::ticks_ahead(0.08, steady), std::clamp(0.032 / drift, 4.0, 8.0));
    EXPECT_EQ(CacheSchedule::ticks_ahead(0.08, directed), 4);
    EXPECT_EQ(CacheSchedule::ticks_ahead(0.08, trembling), 0);
    EXPECT_EQ(CacheSchedule::reserve(0.08, steady), 0);
    EXPECT_EQ(CacheSchedule::reserve(0.08, directed), 0);
    EXPECT_DOUBLE_EQ(CacheSchedule::reserve(0.08, trembling), 0.02);
  }
  EXPECT_DOUBLE_EQ(CacheSchedule::reserve(0.08, {0, 0, 0}), 0.02);
}

TEST(CacheSchedule, AFullCacheHalvesTheSlackAndIsFollowedByAPause) {
  CacheSchedule schedule(kVoxel, false);
  double slack = schedule.slack({1, 1, 1});
  int waited = 0;
  for (int i = 1; i <= 12; ++i) {
    ASSERT_TRUE(schedule.may_fit(100, 1000));
    schedule.was_full(false);
    EXPECT_DOUBLE_EQ(schedule.slack({1, 1, 1}), 0.5 * slack);
    slack = schedule.slack({1, 1, 1});
    for (waited = 0; !schedule.may_fit(100, 1000); ++waited) schedule.tick();
    EXPECT_EQ(waited, std::min((1 << i) - 1, 255));
  }
  schedule.took_up(false, 0);
  EXPECT_DOUBLE_EQ(schedule.slack({1, 1, 1}), 1.25 * slack);
  schedule.was_full(false);
  schedule.tick();
  EXPECT_TRUE(schedule.may_fit(100, 1000));
  for (int i = 0; i < 1000; ++i) schedule.searched();
  EXPECT_DOUBLE_EQ(schedule.slack({1, 1, 1}), 0.4 * kVoxel);
}

TEST(CacheSchedule, PairsThatHardlyFitAreNotTried) {
  const CacheSchedule schedule(kVoxel, false);
  EXPECT_TRUE(schedule.may_fit(888, 1000));
  EXPECT_FALSE(schedule.may_fit(889, 1000));
}

TEST(CacheSchedule, AClearanceAsksForTwiceTheLastOneUnlessItIsKnownToBeLess) {
  CacheSchedule schedule(kVoxel, false);
  EXPECT_DOUBLE_EQ(schedule.clearance(kFar, 0.1), 0.4 * kVoxel);
  schedule.took_up(true, 1);
  EXPECT_DOUBLE_EQ(schedule.clearance(kFar, 0.1), 2);
  EXPECT_DOUBLE_EQ(schedule.clearance(1, 0.1), 0.7);
  schedule.was_full(true);
  EXPECT_DOUBLE_EQ(schedule.clearance(kFar, 0.1), 0.5);
}

TEST(CacheSchedule, AWideCacheIsWastefulWhereMostOfItDoesNotOverlap) {
  EXPECT_TRUE(CacheSchedule::is_wasteful(0.08, 0.01, 2000, 1000));
  EXPECT_FALSE(CacheSchedule::is_wasteful(0.08, 0.05, 2000, 1000));
  EXPECT_FALSE(CacheSchedule::is_wasteful(0.08, 0.01, 1200, 1000));
  EXPECT_FALSE(CacheSchedule::is_wasteful(0.08, 0.01, 2000, 0));  // a clearance may be wide
}

// A search is spread over the ticks ahead, with some to spare; a tick that searches has little
// more.
TEST(CacheSchedule, SlicesMakeTheCacheInTime) {
  const std::uint64_t whole = 100'000;
  EXPECT_GT(CacheSchedule::kTicksAhead * static_cast<double>(CacheSchedule::slice(whole, false)),
            1.5 * static_cast<double>(whole));
  EXPECT_EQ(CacheSchedule::slice(whole, true), whole / 5);
  EXPECT_EQ(CacheSchedule::slice(10, false), 2000u);
}

}  // namespace
}  // namespace ist::test
