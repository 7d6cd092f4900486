// The search that fills a cache gives the same cache in parts of any size and in one go, float for
// float.

#include "ist/query/pair_cache/cache_filler.h"

#include <gtest/gtest.h>

#include <string>

#include "query/pair_cache/cache_case.h"
#include "query/test_clocks.h"

namespace ist::test {
namespace {

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
