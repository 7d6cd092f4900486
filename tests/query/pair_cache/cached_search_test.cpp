#include "ist/query/pair_cache/cached_search.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/pair_cache/cache_case.h"
#include "query/scenes.h"
#include "support/effort.h"

namespace ist::test {
namespace {

// A cache is carried from tick to tick. It answers some ticks, and others make the next cache.

// A carried cache, and a fresh search if the cache has no answer.
class CarriedCache {
 public:
  CarriedCache(const CacheCase& bodies, std::size_t front_pairs)
      : bodies_(bodies),
        search_(bodies.plan, bodies.kernels, 1 << 16),
        carried_(bodies.fixed, bodies.moving, bodies.policy, bodies.plan, bodies.kernels,
                 CacheOptions{1 << 16, front_pairs, 1, std::chrono::nanoseconds(0)}) {}

  // One tick. Returns the number of leaf pairs. A fresh search finds the same number.
  std::size_t tick(const Eigen::Isometry3d& pose) {
    const RelativePose at = bodies_.relative(pose);
    const SearchPose from = to_float(at, bodies_.fixed_lengths, bodies_.moving_lengths);
    found_ = carried_.find(at, 0, {});
    std::vector<LeafPair> fresh(kRoom), kept(kRoom);
    LeafPairSink wanted(bodies_.plan, bodies_.kernels, fresh),
        made(bodies_.plan, bodies_.kernels, kept);
    PairLister lister(from, wanted);
    search_.run(lister);
    if (found_.cache != nullptr) {
      EXPECT_TRUE(carried_.pass_on(*found_.cache, from, Budget{}, made));
      kept.resize(made.count());
      fresh.resize(wanted.count());
      EXPECT_EQ(kept, fresh);
    }
    // The pairs of the cache have changed: it was taken up, or made in this tick.
    if (found_.cache != nullptr && found_.tests > 0) ++at_once_;
    if (found_.cache != nullptr && found_.tests == 0) {
      ++answered_;
      taken_up_ += found_.cache == last_ ? 0 : 1;
      last_ = found_.cache;
    }
    carried_.prepare(at, 0, wanted.count(), found_.cache != nullptr ? found_.tests : lister.tests(),
                     {});
    ++ticks_;
    return wanted.count();
  }

  [[nodiscard]] const CachedSearch::CacheAt& found() const { return found_; }
  [[nodiscard]] int answered() const { return answered_; }
  [[nodiscard]] int taken_up() const { return taken_up_; }
  [[nodiscard]] int at_once() const { return at_once_; }
  [[nodiscard]] int fresh() const { return ticks_ - answered_ - at_once_; }

 private:
  static constexpr std::size_t kRoom = 1 << 17;
  const CacheCase& bodies_;
  Search search_;
  CachedSearch carried_;
  CachedSearch::CacheAt found_;
  const PairCache* last_ = nullptr;
  int ticks_ = 0, answered_ = 0, taken_up_ = 0, at_once_ = 0;
};

class CarriedCacheOf : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  const Scene& scene_ = solids()[0];
  const CacheCase bodies_{scene_.fixed, scene_.moving, GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Policies, CarriedCacheOf, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

// Each cache lasts for some ticks; the next one is made in slices while it does.
TEST_P(CarriedCacheOf, IsFollowedByTheNextThatWasMadeInSlices) {
  CarriedCache cache(bodies_, 1 << 15);
  Eigen::Isometry3d pose = scene_.pose;
  std::size_t pairs = 0;
  int fresh_at_first = 0;
  for (int i = 0; i < 400 && !HasFailure(); ++i) {
    pose.translation() += 0.02 * bodies_.voxel * Eigen::Vector3d(0.6, 0, i < 200 ? 0.8 : -0.8);
    pairs += cache.tick(pose);
    if (i == 30) fresh_at_first = cache.fresh();
  }
  EXPECT_GT(pairs, 100'000u);
  EXPECT_GE(cache.taken_up(), 5);
  EXPECT_LE(cache.fresh() - fresh_at_first, 20);
}

TEST_P(CarriedCacheOf, LastsAtRest) {
  CarriedCache cache(bodies_, 1 << 15);
  for (int i = 0; i < 100; ++i) {
    cache.tick(scene_.pose);
    if (i < 20) continue;
    ASSERT_NE(cache.found().cache, nullptr) << i;
    EXPECT_EQ(cache.found().tests, 0u);
    EXPECT_LE(cache.found().motion, 1e-9);
  }
  EXPECT_LE(cache.taken_up(), 3);
}

// A body that a device moves in steps seems to stand at most ticks. The next cache is there before
// a large step leads out of the last one.
TEST_P(CarriedCacheOf, IsFollowedInTimeWhereABodyMovesInSteps) {
  IST_SLOW();
  CarriedCache cache(bodies_, 1 << 15);
  Eigen::Isometry3d pose = scene_.pose;
  Random random(6);
  constexpr int kTicks = 2000;
  for (int i = 0; i < kTicks && !HasFailure(); ++i) {
    const double step = random.below(40) == 0 ? random.uniform(0.001, 0.012) : 0.0001;
    pose.translation()[2] += (i < kTicks / 2 ? step : -step) * bodies_.voxel;
    cache.tick(pose);
  }
  EXPECT_GE(cache.taken_up(), 5);
  EXPECT_EQ(cache.fresh() + cache.at_once(), 2);  // the first two
}

// The leaf pairs would fit, a cache with slack does not: the next ones get less of it, until one
// fits or all ticks are fresh searches.
TEST_P(CarriedCacheOf, ThatIsFullIsFollowedByOneWithLessSlack) {
  std::size_t pairs = 0;
  {
    CarriedCache cache(bodies_, 1);
    pairs = cache.tick(scene_.pose);
    ASSERT_GT(pairs, 400u);
    EXPECT_EQ(cache.found().cache, nullptr);
  }
  const std::size_t room = pairs + pairs / 8 + 1;
  PairCache kept(room);
  CacheFiller search(bodies_.plan, bodies_.kernels, 1 << 16);
  search.begin(kept, bodies_.wanted(bodies_.relative(scene_.pose), 0.4 * bodies_.voxel));
  search.advance({});
  ASSERT_TRUE(search.is_full());
  CarriedCache none(bodies_, 1), cache(bodies_, room), roomy(bodies_, 4 * room + 1000);
  Eigen::Isometry3d pose = scene_.pose;
  double widest = 0;
  for (int i = 0; i < 60; ++i) {
    pose.translation()[2] += (i / 10 % 2 == 0 ? 0.02 : -0.02) * bodies_.voxel;  // where it began
    none.tick(pose);
    cache.tick(pose);
    roomy.tick(pose);
    if (cache.found().cache != nullptr) widest = std::max(widest, cache.found().cache->extent);
  }
  EXPECT_EQ(none.fresh(), 60);
  EXPECT_GT(roomy.answered(), 40);
  EXPECT_GT(cache.fresh(), roomy.fresh());
  EXPECT_LT(widest, 0.3 * bodies_.voxel);
}

// If a deadline ended the query, the next tick does not try it again.
TEST_P(CarriedCacheOf, ThatIsFullIsNotTriedInEachTick) {
  const RelativePose at = bodies_.relative(scene_.pose);
  PairCache all(1 << 16);
  CacheFiller search(bodies_.plan, bodies_.kernels, 1 << 16);
  search.begin(all, bodies_.wanted(at, 0.1 * bodies_.voxel));
  search.advance({});
  ASSERT_TRUE(search.is_whole());
  const std::size_t room = all.lanes.pair_count - 1;
  CachedSearch carried(bodies_.fixed, bodies_.moving, bodies_.policy, bodies_.plan, bodies_.kernels,
                       CacheOptions{1 << 16, room, 1, std::chrono::nanoseconds(0)});
  EXPECT_EQ(carried.find(at, 0, {}).tests, 0u);
  carried.prepare(at, 0, room / 2, 1000, {});  // so few that a cache seems to fit
  const CachedSearch::CacheAt full = carried.find(at, 0, {});
  EXPECT_EQ(full.cache, nullptr);
  EXPECT_GT(full.tests, 0u);
  EXPECT_EQ(carried.find(at, 0, {}).tests, 0u);
}

// A clearance is an empty cache. It grows while the bodies stay apart.
TEST_P(CarriedCacheOf, IsEmptyWhereBodiesAreApart) {
  CarriedCache cache(bodies_, 1 << 12);
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(cache.tick(shift({1.9 + 0.4, 0, 0})), 0u);
  }
  ASSERT_NE(cache.found().cache, nullptr);
  EXPECT_TRUE(cache.found().cache->empty());
  EXPECT_GE(cache.found().upper, 0.4);
  EXPECT_LE(cache.found().cache->extent, 0.4);
  EXPECT_GT(cache.answered(), 40);
}

// A search in parts finds the same pairs as a search in one go, in the same order. The ends of the
// parts and the size of the memory make no difference.

class ResumedSearch : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  // Returns all leaf pairs of a search in parts. Part `part` makes `tests(part)` tests.
  template <class Tests>
  static std::vector<LeafPair> in_parts(Search& search, const SearchPlan& plan,
                                        const SearchPose& pose, std::size_t room,
                                        const Tests& tests) {
    std::vector<LeafPair> out(room);
    LeafPairSink sink(plan, select_kernels(""), out);
    SearchPosition at = search.roots();
    for (int part = 0; !at.is_end() && part < 1'000'000; ++part) {
      PairLister lister(pose, sink, BudgetMeter({.tests = tests(part)}));
      at = search.resume(at, lister);
    }
    EXPECT_TRUE(at.is_end());
    EXPECT_LE(sink.count(), room);
    out.resize(sink.count());
    return out;
  }
};

INSTANTIATE_TEST_SUITE_P(Policies, ResumedSearch, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(ResumedSearch, FindsTheSamePairsInTheSameOrder) {
  Random random(1);
  std::size_t found = 0;
  for (const Scene& scene : solids()) {
    const SearchPlan plan(scene.fixed, scene.moving, GetParam());
    const TreeLengths fixed = lengths_of(scene.fixed, GetParam()),
                      moving = lengths_of(scene.moving, GetParam());
    const RelativePose relative =
        *relative_pose(scene.pose, parts_of(scene.fixed).origin, parts_of(scene.moving).origin);
    // With the largest margin the rows of inner steps are longer than a piece.
    for (const double voxels : {0.0, 1.0, 5.0}) {
      const double voxel = std::min(scene.fixed.voxel_size(), scene.moving.voxel_size());
      const SearchPose pose = to_float(relative, fixed, moving, voxels * voxel);
      Search wide(plan, select_kernels(""), 1 << 16);
      std::vector<LeafPair> all(1 << 20);
      LeafPairSink sink(plan, select_kernels(""), all);
      PairLister lister(pose, sink);
      wide.run(lister);
      ASSERT_LE(sink.count() + 100, all.size());
      all.resize(sink.count());
      found += all.size();
      for (const std::size_t memory : {std::size_t{1} << 16, std::size_t{300}, std::size_t{1}}) {
        SCOPED_TRACE(scene.name + ", " + std::to_string(voxels) + " voxels, memory for " +
                     std::to_string(memory));
        Search search(plan, select_kernels(""), memory);
        for (const std::uint64_t tests : {448u, 449u, 1000u, 30'000u}) {
          EXPECT_EQ(in_parts(search, plan, pose, all.size() + 100, [&](int) { return tests; }), all)
              << tests;
        }
        // Some of these parts are too small for any test.
        EXPECT_EQ(
            in_parts(search, plan, pose, all.size() + 100, [&](int) { return random.below(2000); }),
            all);
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_GT(found, 50'000u);
}

// A search that was left unfinished does not change the next one.
TEST_P(ResumedSearch, IsForgottenByTheNextOne) {
  const Scene& scene = solids()[1];
  const SearchPlan plan(scene.fixed, scene.moving, GetParam());
  const RelativePose relative =
      *relative_pose(scene.pose, parts_of(scene.fixed).origin, parts_of(scene.moving).origin);
  const SearchPose pose = to_float(relative, lengths_of(scene.fixed, GetParam()),
                                   lengths_of(scene.moving, GetParam()), 0.2);
  Search search(plan, select_kernels(""), 1 << 16);
  std::vector<LeafPair> expected;
  for (std::uint64_t tests = 0; tests < 20'000; tests = tests * 5 / 4 + 100) {
    std::vector<LeafPair> out(1 << 20), unused(1 << 20);
    LeafPairSink cut(plan, select_kernels(""), unused), sink(plan, select_kernels(""), out);
    if (tests > 0) {
      PairLister some(pose, cut, BudgetMeter({.tests = tests}));
      static_cast<void>(search.resume(search.roots(), some));
    }
    PairLister all(pose, sink);
    ASSERT_TRUE(search.resume(search.roots(), all).is_end());
    out.resize(sink.count());
    if (tests == 0) expected = out;
    ASSERT_GT(out.size(), 100u);
    ASSERT_EQ(out, expected) << tests;
  }
}

}  // namespace
}  // namespace ist::test
