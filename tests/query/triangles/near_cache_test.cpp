#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/triangles/cluster_walk.h"
#include "query/pair_cache/motions.h"
#include "query/scenes.h"
#include "query/test_clocks.h"
#include "query/triangles/triangle_tree.h"
#include "simd/targets.h"
#include "simd/triangles/cluster_cases.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// A query that keeps near pairs beside one that keeps none.
class NearCacheRun {
 public:
  NearCacheRun(const SphereTree& fixed, const SphereTree& moving, const QueryOptions& options)
      : carried_(fixed, moving, options), fresh_(fixed, moving) {}

  void check(const Eigen::Isometry3d& pose, double margin, std::size_t room = 1 << 14) {
    made_.resize(room);
    wanted_.resize(room);
    const NearPairsResult made = carried_.near_pairs(pose, margin, made_);
    const NearPairsResult wanted = fresh_.near_pairs(pose, margin, wanted_);
    ASSERT_EQ(made.status, wanted.status);
    ASSERT_EQ(made.complete, wanted.complete);
    ASSERT_EQ(made.near_pairs, wanted.near_pairs);
    ASSERT_EQ(made.truncated, wanted.truncated);
    ASSERT_EQ(made.pad, wanted.pad);
    for (std::size_t k = 0; k < std::min<std::size_t>(room, made.near_pairs); ++k) {
      ASSERT_EQ(made_[k].triangles, wanted_[k].triangles);
      ASSERT_EQ(std::memcmp(&made_[k].distance, &wanted_[k].distance, 7 * sizeof(double)), 0);
      ASSERT_EQ(made_[k].fixed_part, wanted_[k].fixed_part);
      ASSERT_EQ(made_[k].moving_part, wanted_[k].moving_part);
    }
    ++ticks;
    pairs += made.near_pairs;
    kept += made.found == Found::kKept ? 1 : 0;
  }
  [[nodiscard]] Query& carried() { return carried_; }

  std::size_t ticks = 0, kept = 0, pairs = 0;

 private:
  Query carried_, fresh_;
  std::vector<NearPair> made_, wanted_;
};

// Balls, a block, and a ball almost on itself, with triangles.
std::vector<Scene> scenes() {
  const SphereTree ball = triangle_tree(icosphere(3, 1), 16);
  const SphereTree block = triangle_tree(box({-1, -0.5, -0.7}, {1, 0.5, 0.7}), 12);
  return {{"balls", ball, triangle_tree(icosphere(4, 0.7), 12), shift({1.69, 0, 0})},
          {"ball and block", ball, block, shift({1.99, 0.1, 0})},
          {"shells", ball, triangle_tree(icosphere(3, 0.98), 16), shift({0.01, 0, 0})}};
}

TEST(NearCache, AnswersAsAFreshQueryOnAnyMotion) {
  const std::vector<Scene> all = scenes();
  std::size_t ticks = 0, kept = 0, pairs = 0;
  const std::vector<std::string> targets = all_targets();
  for (int k = 0; k < samples(60) && !HasFailure(); ++k) {
    SCOPED_TRACE(k);
    Random random(static_cast<std::uint64_t>(k));
    const Scene& scene = all[random.below(all.size())];
    const double voxel = scene.moving.voxel_size();
    const std::size_t rooms[] = {1, 50, 2048, 1 << 15};
    NearCacheRun run(scene.fixed, scene.moving,
                     {.target = targets[random.below(targets.size())],
                      .workers = k % 2 + 1,
                      .near_pairs = rooms[random.below(std::size(rooms))]});
    Motion motion(scene, random.below(1U << 31));
    motion.limit_step(random.below(3) > 0 ? 0.02 : 1);
    double margin = 0.3 * voxel;
    for (int tick = 0; tick < 90 && !HasFatalFailure(); ++tick) {
      SCOPED_TRACE(tick);
      if (random.below(30) == 0) margin = random.uniform(0, 1) * voxel;
      if (random.below(40) == 0) run.carried().forget();
      run.check(motion.next(), margin, random.below(8) == 0 ? 5 : 1 << 14);
    }
    ticks += run.ticks;
    kept += run.kept;
    pairs += run.pairs;
  }
  EXPECT_GT(kept, ticks / 8);
  EXPECT_LT(kept, ticks);
  EXPECT_GT(pairs, ticks);
}

// Two balls that roll on each other: all but the first ticks are answered by a list.
TEST(NearCache, KeepsItsListsWhereABodyMovesSlowly) {
  const SphereTree ball = triangle_tree(icosphere(4, 1), 8);
  NearCacheRun run(ball, ball, {.near_pairs = 4096});
  for (int tick = 0; tick < 600 && !HasFatalFailure(); ++tick) {
    const double angle = 0.0004 * (tick < 300 ? tick : 600 - tick);  // there and back
    run.check(pose_of(Eigen::AngleAxisd(angle, Eigen::Vector3d(0.6, 0, 0.8)).toRotationMatrix(),
                      2.003 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)),
              0.02);
  }
  EXPECT_GT(run.kept, run.ticks - 20);
  std::vector<NearPair> out(1 << 12);
  const Eigen::Isometry3d pose = shift({2.003, 0, 0});
  EXPECT_EQ(run.carried().near_pairs(pose, 0.02, out).found, Found::kKept);
  run.carried().forget();
  EXPECT_EQ(run.carried().near_pairs(pose, 0.02, out).found, Found::kFresh);
  EXPECT_GT(run.pairs, run.ticks);
}

// Two balls slide past each other, at several speeds. A list does not answer if it is too wide:
// what it measures again costs at most 1.1 times a search. A pair of a list costs some 24 tests,
// and a pair that a search finds 48.
TEST(NearCache, MeasuresNoMoreThanASearchCosts) {
  const SphereTree ball = triangle_tree(icosphere(4, 1), 8);
  std::size_t kept = 0, searched = 0;
  for (const double speed : {0.0001, 0.0003, 0.0005, 0.001, 0.003}) {
    SCOPED_TRACE(speed);
    Query query(ball, ball, {.near_pairs = 1 << 14});
    std::vector<NearPair> out(1 << 14);
    std::uint64_t search = 0;
    for (int tick = 0; tick < 200; ++tick) {
      const double angle = speed * tick;
      const Eigen::Isometry3d pose =
          shift(2.002 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
      const NearPairsResult result = query.near_pairs(pose, 0.01, out);
      ASSERT_TRUE(result.complete);
      if (result.found == Found::kKept) {
        EXPECT_LE(24 * result.sphere_tests, search + search / 10);
        ++kept;
      } else {
        search = std::max(search, result.sphere_tests + 48 * result.near_pairs);
        ++searched;
      }
    }
  }
  EXPECT_GT(kept, 200u);
  EXPECT_GT(searched, 200u);
}

// A list without room, a body that is too fast, a deadline and a budget: each answers nevertheless.
TEST(NearCache, AnswersWhereItCannotKeep) {
  const SphereTree ball = triangle_tree(icosphere(4, 1), 8);
  NearCacheRun small(ball, ball, {.near_pairs = 1}), fast(ball, ball, {.near_pairs = 4096});
  for (int tick = 0; tick < 100 && !HasFatalFailure(); ++tick) {
    small.check(shift({1.9 + 1e-4 * tick, 0, 0}), 0.2);
    fast.check(shift({2, 0.02 * tick * tick, 0}), 0.05);
  }
  EXPECT_EQ(fast.kept, 0u);
  std::vector<NearPair> out(1 << 12);
  Query& query = small.carried();
  const ScopedBudgetClock clock(&LateClock::now);
  for (int looks = 0; looks < 20; ++looks) {
    const NearPairsResult late =
        query.near_pairs(shift({2.001, 0, 0}), 0.05, out, LateClock::budget_of(looks));
    EXPECT_LE(late.near_pairs, out.size());
  }
  Budget budget;
  budget.tests = 10;
  EXPECT_FALSE(query.near_pairs(shift({2.001, 0, 0}), 0.05, out, budget).complete);
}

TEST(NearCache, RefusesMoreThanItCanCount) {
  const SphereTree ball = triangle_tree(icosphere(1, 1), 8);
  EXPECT_THROW(Query(ball, ball, {.near_pairs = std::size_t{1} << 60}), Error);
  EXPECT_GT(Query(ball, ball, {.near_pairs = 1000}).bytes(), Query(ball, ball).bytes() + 300'000);
}

// Collects the pairs of clusters that a search comes to.
struct CollectedPairs {
  static constexpr bool kMostFirst = false, kMeasuresRest = false;
  [[nodiscard]] float reach() const { return within; }
  bool visit(const ClusterPairs& clusters) {
    for (std::size_t k = 0; k < clusters.pairs.count; ++k) {
      found.emplace_back(clusters.moving + clusters.pairs.lane(k), clusters.pairs.node(k));
    }
    return true;
  }
  float within;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
};

// A walk comes to the same pairs in the same order, with the same tests, however it is cut.
TEST(ClusterWalk, IsASearchInSlices) {
  std::size_t pairs = 0;
  for (const ClusterCase& bodies : cluster_cases()) {
    SCOPED_TRACE(bodies.name);
    const TriangleClusters &fixed = bodies.fixed_clusters, &moving = bodies.moving_clusters;
    const ClusterKernels& kernels = select_kernels("").clusters;
    ClusterSearch search(fixed, moving, kernels);
    search.begin(bodies.step.pose);
    const float within = bodies.step.pose.error + 0.02F;
    CollectedPairs whole{within, {}}, parts{within, {}};
    BudgetMeter meter;
    EXPECT_TRUE(search.run(meter, whole));
    ClusterWalk walk(fixed, moving, kernels);
    for (int times = 0; times < 2; ++times) {
      parts.found.clear();
      walk.begin(bodies.step.pose, within);
      while (!walk.is_whole()) {
        EXPECT_TRUE(walk.advance([&](const ClusterPairs& some) { return parts.visit(some); }));
      }
      EXPECT_EQ(parts.found, whole.found);
      EXPECT_EQ(walk.tests(), meter.spent());
    }
    pairs += whole.found.size();
  }
  EXPECT_GT(pairs, 0u);
}

}  // namespace
}  // namespace ist::test
