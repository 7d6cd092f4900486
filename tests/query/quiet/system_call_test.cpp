#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <thread>
#include <vector>

#include "ist/query/workers/resident_worker.h"
#include "ist/query/workers/shared_work.h"
#include "ist/query/world/world.h"
#include "query/every_verb.h"
#include "query/quiet/allocations.h"
#include "query/quiet/locks.h"
#include "query/scenes.h"
#include "query/triangles/triangle_tree.h"
#include "support/effort.h"
#include "support/shapes.h"
#include "support/system_calls.h"

namespace ist::test {
namespace {

/// Balls in a row, each near the next: one pair ignored, and memory for some.
inline World row_of_balls(std::size_t threads = 1) {
  WorldOptions options;
  options.query.frontier_pairs = 1 << 10;
  options.query.front_pairs = 1 << 10;
  options.pair_caches = 4;
  options.threads = threads;
  World world(options);
  const SphereTree ball = triangle_tree(icosphere(2, 1), 10);
  for (int i = 0; i < 12; ++i) world.add(ball, shift({1.8 * i, 0, 0}));
  world.ignore(0, 1);
  world.reserve(9);
  return world;
}

/// Asks every verb, while bodies pass each other, far and near, and lose their poses.
/// Returns the sum of all counts.
inline std::uint64_t ask_everything(World& world, std::vector<LeafPair>& leaves,
                                    std::vector<TrianglePair>& triangles) {
  std::uint64_t found = 0;
  for (int tick = 0; tick < 40; ++tick) {
    Budget budget;
    if (tick % 5 == 0) budget.tests = 3000;
    if (tick % 7 == 0) budget.deadline = Budget::Clock::now() + std::chrono::microseconds(50);
    for (BodyIndex body = 0; body < 12; ++body) {
      Eigen::Vector3d to(1.8 * body, 0.05 * tick, 0);
      to[(tick / 10) % 3] += 3.0 * ((body + static_cast<BodyIndex>(tick)) % 5);
      Eigen::Isometry3d pose = shift(to);
      if (tick % 11 == 10 && body == 3) pose.translation()[0] = HUGE_VAL;
      static_cast<void>(world.set_pose(body, pose));
    }
    found += world.ask({}).near_pairs;
    for (const WorldQuestion& question :
         {WorldQuestion{WorldQuestion::kIntersects}, WorldQuestion{WorldQuestion::kContacts},
          WorldQuestion{.kind = WorldQuestion::kLeafPairs, .leaf_pairs = leaves},
          WorldQuestion{.kind = WorldQuestion::kTrianglePairs, .triangle_pairs = triangles},
          WorldQuestion{WorldQuestion::kDistance, 0.01}}) {
      for (const WorldPair& pair : world.ask(question, budget).pairs) {
        found += pair.sphere_tests + pair.found;
      }
    }
    found += world.distance(0.01, budget).sphere_tests;
    if (tick % 13 == 0) world.forget();
  }
  return found;
}

using namespace std::chrono_literals;

// Each in a child process, begun anew, that ends at the first system call.
class SystemCalls : public ::testing::Test {
 protected:
  void SetUp() override {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    if (kSanitized) GTEST_SKIP() << "sanitizers call the system themselves";
    if (!can_forbid_system_calls()) IST_SKIP("this kernel does not filter system calls");
  }
};

// Queries along the scene's closing, before and after system calls are forbidden. Goes on until the
// second worker, if there is one, has done its part.
void query_in_silence(const Scene& scene, SpherePolicy policy, int workers) {
  std::vector<LeafPair> out(1 << 16);
  Query query(scene.fixed, scene.moving, options_of(policy, "", workers));
  const auto enough = [&](std::uint64_t helped) {
    return workers == 1 || sharing_of(query).chunks >= helped;
  };
  while (!enough(1)) {  // it is there
    static_cast<void>(query.leaf_pairs(scene.pose, out));
  }
  const std::uint64_t helped = sharing_of(query).chunks + 100;
  forbid_system_calls();
  for (int i = 0; i < 1000 || !enough(helped); ++i) {
    Eigen::Isometry3d pose = scene.pose;
    pose.translation()[2] += 0.01 * (i % 100);
    static_cast<void>(query.leaf_pairs(pose, out));
  }
  end_process(0);
}

// Counts the parts that the second worker has done.
std::atomic<int> parts_done{0};
void count_part(HandOver at) noexcept { parts_done += at == HandOver::kWorked ? 1 : 0; }

// A slow way with a cache that is kept and made again. Goes on until it was kept often, and the
// worker, if there is one, has made some.
void carry_in_silence(const Scene& scene, int workers) {
  std::vector<LeafPair> out(1 << 16);
  QueryOptions options = options_of(SpherePolicy::kSlab, "", workers);
  options.front_pairs = 1 << 15;
  Query query(scene.fixed, scene.moving, options);
  ContactManifold points(scene.fixed, scene.moving, SpherePolicy::kSlab, {.margin = 2});
  Eigen::Isometry3d pose = scene.pose;
  const double step = 0.01 * scene.fixed.voxel_size();
  int ticks = 0, kept = 0;
  hand_over_hook = count_part;
  const auto enough = [&](int much, int parts) {
    return kept > much && (workers == 1 || parts_done >= parts);
  };
  const auto tick = [&] {
    pose.translation()[2] += ticks / 500 % 2 == 0 ? step : -step;
    const Budget budget{.deadline = Budget::Clock::now() + 1h};
    const QueryResult result =
        ticks++ % 2 == 0 ? query.contacts(pose, points, budget) : query.leaf_pairs(pose, out);
    kept += result.found == Found::kKept ? 1 : 0;
  };
  for (int i = 0; i < 500 || !enough(0, 1); ++i) tick();  // the worker is there
  kept = 0;
  const int parts = parts_done + 10;
  forbid_system_calls();
  for (int i = 0; i < 2000 || !enough(500, parts); ++i) tick();
  for (int i = 0; i < 50; ++i) {
    static_cast<void>(query.contacts(i % 2 == 0 ? scene.pose : shift({2.2, 0, 0}), points));
  }
  end_process(0);
}

TEST_F(SystemCalls, AreCaught) {
  EXPECT_EXIT(
      {
        forbid_system_calls();
        static_cast<void>(getppid());
        end_process(0);
      },
      ::testing::KilledBySignal(SIGSYS), "");
  EXPECT_EXIT(
      {
        forbid_system_calls();
        end_process(7);
      },
      ::testing::ExitedWithCode(7), "");
}

TEST_F(SystemCalls, AQueryMakesNone) {
  for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
    EXPECT_EXIT(query_in_silence(jaws(), policy, 1), ::testing::ExitedWithCode(0), "");
    EXPECT_EXIT(query_in_silence(solids()[1], policy, 1), ::testing::ExitedWithCode(0), "");
  }
}

TEST_F(SystemCalls, ContactPointsMakeNone) {
  EXPECT_EXIT(
      {
        const Scene& scene = jaws();
        Query query(scene.fixed, scene.moving, options_of(SpherePolicy::kSlab));
        ContactManifold points(scene.fixed, scene.moving, SpherePolicy::kSlab, {32, 100, 2});
        forbid_system_calls();
        for (int i = 0; i < 100; ++i) {
          Eigen::Isometry3d pose = scene.pose;
          pose.translation()[2] += 0.01 * i;
          static_cast<void>(query.contacts(pose, points));
        }
        end_process(points.points().size() > 8 ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST_F(SystemCalls, AQueryThatKeepsACacheMakesNone) {
  for (const int workers : {1, 2}) {
    EXPECT_EXIT(carry_in_silence(solids()[0], workers), ::testing::ExitedWithCode(0), "");
  }
}

TEST_F(SystemCalls, NoVerbMakesOne) {
  EXPECT_EXIT(
      {
        const SphereTree tree = triangle_tree(icosphere(3, 1), 20);
        Query query(tree, tree, {.near_pairs = 512});
        VerbRoom room(query);
        std::uint64_t tests = 0;
        const auto count = [&](const auto& result) { tests += result.sphere_tests; };
        forbid_system_calls();
        for (int i = 0; i < 300; ++i) {
          Budget budget;
          if (i % 3 == 1) budget.tests = 1000;
          if (i % 3 == 2) budget.deadline = Budget::Clock::now() + 20us;
          ask_every_verb(query, shift({0.01 * i, 0, 0}), room, budget, count);
        }
        end_process(tests > 1'000'000 ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST_F(SystemCalls, AWorldMakesNone) {
  EXPECT_EXIT(
      {
        World world = row_of_balls();
        std::vector<LeafPair> leaves(1 << 10);
        std::vector<TrianglePair> triangles(1 << 10);
        forbid_system_calls();
        end_process(ask_everything(world, leaves, triangles) > 10000 ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST_F(SystemCalls, ACallerWithASecondWorkerMakesNone) {
  IST_SLOW();
  EXPECT_EXIT(query_in_silence(jaws(), SpherePolicy::kTight, 2), ::testing::ExitedWithCode(0), "");
}

// A world is as quiet as its queries.

TEST(Allocations, AWorldMakesNone) {
  for (const std::size_t threads : {1u, 2u}) {
    World world = row_of_balls(threads);
    std::vector<LeafPair> leaves(1 << 10);
    std::vector<TrianglePair> triangles(1 << 10);
    // A thread allocates when it begins.
    for (int k = 0; threads > 1 && k < 1000 && !ResidentWorker::is_there(); ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const std::uint64_t before = allocations();
    const std::uint64_t found = ask_everything(world, leaves, triangles);
    EXPECT_EQ(allocations() - before, 0u);
    EXPECT_GT(found, 10000u);
  }
}

TEST(Locks, AWorldAsksForNone) {
  for (const std::size_t threads : {1u, 2u}) {
    World world = row_of_balls(threads);
    std::vector<LeafPair> leaves(1 << 10);
    std::vector<TrianglePair> triangles(1 << 10);
    const std::uint64_t before = locks();
    static_cast<void>(ask_everything(world, leaves, triangles));
    EXPECT_EQ(locks() - before, 0u);
  }
}

}  // namespace
}  // namespace ist::test
