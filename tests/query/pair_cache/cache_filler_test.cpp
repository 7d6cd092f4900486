#include "ist/query/pair_cache/cache_filler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "ist/query/pair_cache/cache_schedule.h"
#include "query/pair_cache/cache_case.h"
#include "query/test_clocks.h"

namespace ist::test {
namespace {

// The schedule decides when a new cache pays for its search, and how wide the cache is.

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

// The next cache begins two fifths of the way to its centre before this one is used up, and at
// least four ticks before. If the direction of the body is unknown, it begins when a fourth of the
// slack is left.
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

// The search that fills a cache gives the same cache in parts of any size and in one go, float for
// float.

constexpr std::size_t kRoom = 1 << 17;
// Each slice of kPiece tests goes on: a piece of a step has no more.
constexpr std::uint64_t kPiece = kPieceTests;

class CacheFillerOf : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  // Makes a cache slice by slice. Returns the number of slices.
  template <class Slice>
  static int in_slices(CacheFiller& search, PairCache& cache, const CacheFiller::Wanted& wanted,
                       const Slice& slice) {
    search.begin(cache, wanted);
    int slices = 0;
    std::uint64_t spent = 0;
    while (is_under_way(search) && slices < 100'000) {
      const std::uint64_t tests = slice(slices);
      search.advance({.tests = tests});
      EXPECT_LE(search.tests() - spent, tests);
      spent = search.tests();
      ++slices;
    }
    EXPECT_TRUE(search.is_whole());
    return slices;
  }
  static bool is_under_way(const CacheFiller& search) {
    return !search.is_whole() && !search.is_full();
  }
  // Makes a cache in one go. Returns whether it is whole.
  static bool fill(CacheFiller& search, PairCache& cache, const CacheFiller::Wanted& wanted) {
    search.begin(cache, wanted);
    search.advance({});
    return search.is_whole();
  }

  // Returns the pose of a scene, and poses that are moved away from it.
  static std::vector<Eigen::Isometry3d> poses(const Scene& scene) {
    std::vector<Eigen::Isometry3d> all{scene.pose};
    Random random(5);
    for (const double far : {0.3, 1.0, 3.0}) {
      all.push_back(scene.pose);
      all.back().translation() += far * random.direction();
    }
    return all;
  }
};

INSTANTIATE_TEST_SUITE_P(Policies, CacheFillerOf, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(CacheFillerOf, GivesInSlicesWhatItGivesInOneGo) {
  Random random(1);
  std::size_t pairs = 0;
  int slices = 0;
  for (const Scene& scene : solids()) {
    const CacheCase scene_case(scene.fixed, scene.moving, GetParam());
    const bool slabs = GetParam() == SpherePolicy::kSlab;
    PairCache whole(kRoom), sliced(kRoom);
    CacheFiller search(scene_case.plan, scene_case.kernels, 1 << 16),
        tiny(scene_case.plan, scene_case.kernels, 1);
    for (const Eigen::Isometry3d& pose : poses(scene)) {
      // With the widest extent the rows of inner steps are longer than a piece.
      for (const double voxels : {0.0, 0.4, 1.5, 8.0}) {
        SCOPED_TRACE(scene.name + ", " + std::to_string(voxels) + " voxels");
        const auto wanted = scene_case.wanted(scene_case.relative(pose), voxels * scene_case.voxel);
        if (!fill(search, whole, wanted)) continue;
        const std::uint64_t all = search.tests();
        pairs += whole.lanes.pair_count;
        const auto check = [&](CacheFiller& with, const auto& slice, bool same_tests) {
          slices += in_slices(with, sliced, wanted, slice);
          EXPECT_TRUE(same_cache(sliced, whole, slabs));
          EXPECT_TRUE(!same_tests || with.tests() == all) << with.tests() << " for " << all;
        };
        for (const std::uint64_t tests :
             {kPiece, kPiece + 1, std::uint64_t{777}, std::uint64_t{2000}, std::uint64_t{20'000}}) {
          check(
              search, [&](int) { return tests; }, true);
        }
        check(
            search, [&](int k) { return k == 0 ? all - 1 : kPiece; }, true);
        check(
            search, [&](int) { return 1 + random.below(3 * kPiece); }, true);
        check(
            tiny, [&](int) { return 1 + random.below(5000); }, true);
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_GT(pairs, 50'000u);
  EXPECT_GT(slices, 2'000);
}

// A deadline ends a part in the same way as a limit of tests.
TEST_P(CacheFillerOf, GoesOnAfterADeadline) {
  const ScopedBudgetClock clock(LateClock::now);
  const Scene& scene = solids()[0];
  const CacheCase scene_case(scene.fixed, scene.moving, GetParam());
  PairCache whole(kRoom), parts(kRoom);
  CacheFiller search(scene_case.plan, scene_case.kernels, 1 << 16);
  const auto wanted = scene_case.wanted(scene_case.relative(scene.pose), 0.4 * scene_case.voxel);
  ASSERT_TRUE(fill(search, whole, wanted));
  const std::uint64_t all = search.tests();
  for (const int looks : {1, 2, 3, 10}) {
    search.begin(parts, wanted);
    int times = 0;
    while (is_under_way(search) && ++times < 10'000) {
      search.advance(LateClock::budget_of(looks));
    }
    EXPECT_TRUE(search.is_whole()) << looks << " looks";
    EXPECT_GT(times, 1);
    EXPECT_EQ(search.tests(), all);
    EXPECT_TRUE(same_cache(parts, whole, GetParam() == SpherePolicy::kSlab));
  }
  // A deadline that is past changes nothing.
  search.begin(parts, wanted);
  search.advance(LateClock::budget_of(0));
  EXPECT_TRUE(is_under_way(search));
  EXPECT_EQ(search.tests(), 0u);
  search.advance({});
  EXPECT_TRUE(search.is_whole());
  EXPECT_TRUE(same_cache(parts, whole, GetParam() == SpherePolicy::kSlab));
}

TEST_P(CacheFillerOf, EndsWhereTheCacheIsFullOrTheTestsAreTooMany) {
  const Scene& scene = solids()[0];
  const CacheCase scene_case(scene.fixed, scene.moving, GetParam());
  CacheFiller search(scene_case.plan, scene_case.kernels, 1 << 16);
  const auto wanted = scene_case.wanted(scene_case.relative(scene.pose), 0.4 * scene_case.voxel);
  PairCache whole(kRoom);
  ASSERT_TRUE(fill(search, whole, wanted));
  const std::uint64_t all = search.tests();
  for (const std::size_t room : {std::size_t{1}, std::size_t{100}, whole.lanes.pair_count - 1}) {
    PairCache small(room);
    EXPECT_FALSE(fill(search, small, wanted)) << room;
    EXPECT_TRUE(search.is_full()) << room;
    EXPECT_LE(small.lanes.pair_count, room);
    const std::uint64_t tests = search.tests();
    search.advance({});
    EXPECT_TRUE(search.is_full());
    EXPECT_FALSE(search.is_whole());
    EXPECT_EQ(search.tests(), tests);  // nothing more is tested
    search.begin(small, wanted);
    int slices = 0;
    for (search.advance({.tests = 2000}); is_under_way(search); search.advance({.tests = 2000})) {
      ++slices;
    }
    EXPECT_TRUE(search.is_full()) << room;
    EXPECT_GT(slices, 0);
  }
  PairCache some(kRoom);
  for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{1000}, all - 1, all, all + 1}) {
    for (const std::uint64_t slice : {~std::uint64_t{0}, std::uint64_t{1500}}) {
      search.begin(some, scene_case.wanted(wanted.centre, wanted.extent, most));
      for (int slices = 0; is_under_way(search) && slices < 10'000; ++slices) {
        search.advance({.tests = slice});
      }
      EXPECT_EQ(search.is_whole(), most >= all) << most << " of " << all << " by " << slice;
      EXPECT_EQ(search.is_full(), most < all) << most << " of " << all << " by " << slice;
      EXPECT_LE(search.tests(), most);
    }
  }
  // A search that is left unfinished does not change the next one.
  search.begin(some, wanted);
  search.advance({.tests = 5000});
  EXPECT_TRUE(is_under_way(search));
  EXPECT_TRUE(fill(search, some, wanted));
  EXPECT_TRUE(same_cache(some, whole, GetParam() == SpherePolicy::kSlab));
}

// An empty cache bounds the distance from above if that was wanted.
TEST_P(CacheFillerOf, BoundsTheDistanceOfBodiesThatAreApart) {
  const Scene& scene = solids()[0];  // a ball of radius 1, a block whose face is at x = -0.9
  const CacheCase scene_case(scene.fixed, scene.moving, GetParam());
  CacheFiller search(scene_case.plan, scene_case.kernels, 1 << 16);
  PairCache cache(kRoom);
  for (const double gap : {0.2, 0.3, 0.5}) {
    auto wanted = scene_case.wanted(scene_case.relative(shift({1.9 + gap, 0, 0})), 0.1);
    ASSERT_TRUE(fill(search, cache, wanted));
    EXPECT_TRUE(cache.empty());
    EXPECT_GE(cache.upper, gap - 1e-9);
    EXPECT_TRUE(std::isfinite(cache.upper));
    wanted.measured = Measured::kNothing;
    ASSERT_TRUE(fill(search, cache, wanted));
    EXPECT_EQ(cache.upper, HUGE_VAL);
  }
}

}  // namespace
}  // namespace ist::test
