#include <gtest/gtest.h>

#include <chrono>
#include <new>

#include "ist/query/reference/reference_query.h"
#include "ist/query/workers/shared_work.h"
#include "query/every_verb.h"
#include "query/quiet/allocations.h"
#include "query/scenes.h"
#include "query/triangles/triangle_tree.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

template <class Action>
std::uint64_t allocations_of(const Action& action) {
  const std::uint64_t before = allocations();
  action();
  return allocations() - before;
}

TEST(Allocations, AreCountedHoweverMemoryIsAskedFor) {
  void* volatile memory = nullptr;  // so that nothing is optimised away
  EXPECT_EQ(allocations_of([&] { memory = std::malloc(1); }), 1u);
  EXPECT_EQ(allocations_of([&] { memory = std::realloc(memory, 10000); }), 1u);
  std::free(memory);
  EXPECT_EQ(allocations_of([&] { memory = ::operator new(8); }), 1u);
  ::operator delete(memory);
  EXPECT_EQ(allocations_of([&] { memory = ::operator new (64, std::align_val_t{64}); }), 1u);
  ::operator delete (memory, std::align_val_t{64});
  EXPECT_EQ(allocations_of([] {}), 0u);
}

// Returns the bytes that making an object takes beside those that it states.
template <class Make>
std::int64_t more_than_stated(const Make& make) {
  const std::uint64_t before = allocated_bytes();
  const auto made = make();
  const std::uint64_t after = allocated_bytes();
  return static_cast<std::int64_t>(after - before) - static_cast<std::int64_t>(made.bytes());
}

// Its plan and other parts of one size come beside the bytes that it states.
TEST(Allocations, OfAQueryAreTheBytesThatItStates) {
  constexpr std::int64_t kMostBeside = 74'000;
  const SphereTree exact = triangle_tree(icosphere(3, 1), 20);
  const SphereTree trees[] = {exact, without_triangles(exact)};
  const Query first(exact, exact, {.workers = 2});  // has TBB make its threads
  for (const SphereTree& tree : trees) {
    for (const int workers : {1, 2}) {
      for (const std::size_t front_pairs : {0u, 1000u, 65536u}) {
        for (const std::size_t frontier_pairs : {1u, 300u, 65536u}) {
          QueryOptions options;
          options.workers = workers;
          options.front_pairs = front_pairs;
          options.frontier_pairs = frontier_pairs;
          const std::int64_t beside = more_than_stated([&] { return Query(tree, tree, options); });
          EXPECT_GE(beside, 0) << workers << ", " << front_pairs << ", " << frontier_pairs;
          EXPECT_LE(beside, kMostBeside)
              << workers << ", " << front_pairs << ", " << frontier_pairs;
        }
      }
    }
  }
}

TEST(Allocations, OfAManifoldAreTheBytesThatItStates) {
  const SphereTree tree = triangle_tree(icosphere(3, 1), 20);
  for (const std::size_t points : {0u, 1u, 32u}) {
    for (const std::size_t leaves : {1u, 100u, 1u << 20}) {
      ManifoldOptions options;
      options.points = points;
      options.max_leaves = leaves;
      const std::int64_t beside =
          more_than_stated([&] { return ContactManifold(tree, tree, tree.tightest(), options); });
      EXPECT_GE(beside, 0) << points << ", " << leaves;
      EXPECT_LE(beside, 1000) << points << ", " << leaves;
    }
  }
}

TEST(Allocations, TheReferenceMakesSome) {
  const Scene& scene = solids()[0];
  ReferenceQuery query(scene.fixed, scene.moving, SpherePolicy::kTight);
  EXPECT_GT(allocations_of([&] { static_cast<void>(query.leaf_pairs(scene.pose, {})); }), 0u);
}

// From the very first query on: all was reserved by the constructor. Nor does the worker make any.
TEST(Allocations, AQueryMakesNone) {
  for (const Scene& scene : solids()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const int workers : {1, 2}) {
        std::vector<LeafPair> out(1 << 16);
        Query query(scene.fixed, scene.moving, options_of(policy, "", workers));
        EXPECT_EQ(allocations_of([&] {
                    for (int i = 0; i < 400; ++i) {
                      Eigen::Isometry3d pose = scene.pose;
                      pose.translation()[2] += 0.01 * (i % 100);
                      static_cast<void>(query.leaf_pairs(pose, out));
                    }
                  }),
                  0u)
            << scene.name << ", " << to_string(policy) << ", " << workers << " workers";
      }
    }
  }
}

TEST(Allocations, NorDoesOneThatTheWorkerHelpsWith) {
  const Scene& scene = jaws();
  std::vector<LeafPair> out(1 << 16);
  Query query(scene.fixed, scene.moving, options_of(SpherePolicy::kTight, "", 2));
  EXPECT_EQ(allocations_of([&] {
              while (sharing_of(query).chunks < 200) {
                static_cast<void>(query.leaf_pairs(scene.pose, out));
              }
            }),
            0u);
}

// Nor do contact points, whether there is room for all that is touched or it is merged.
TEST(Allocations, ContactPointsMakeNone) {
  const Scene& scene = solids()[0];
  for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
    for (const std::size_t room : {std::size_t{10}, std::size_t{1} << 15}) {
      Query query(scene.fixed, scene.moving, options_of(policy));
      ContactManifold points(scene.fixed, scene.moving, policy, {32, room, 2});
      std::size_t found = 0;
      EXPECT_EQ(allocations_of([&] {
                  for (int i = 0; i < 100; ++i) {
                    Eigen::Isometry3d pose = scene.pose;
                    pose.translation()[2] += 0.01 * i;
                    static_cast<void>(query.contacts(pose, points));
                    found += points.points().size();
                  }
                }),
                0u);
      EXPECT_GT(found, 500u);
    }
  }
}

// Nor does a query that keeps a cache: where it fits and where it does not, with one worker and
// two, for leaf pairs and contacts, with a deadline and without.
TEST(Allocations, AQueryThatKeepsACacheMakesNone) {
  const Scene& scene = solids()[0];
  for (const int workers : {1, 2}) {
    for (const std::size_t front_pairs : {std::size_t{100}, std::size_t{1} << 15}) {
      QueryOptions options = options_of(SpherePolicy::kSlab, "", workers);
      options.front_pairs = front_pairs;
      std::vector<LeafPair> out(1 << 16);
      Query query(scene.fixed, scene.moving, options);
      ContactManifold points(scene.fixed, scene.moving, SpherePolicy::kSlab, {.margin = 2});
      int kept = 0, clear = 0;
      const auto enough = [&] { return front_pairs == 100 || (kept > 20 && clear > 20); };
      const auto go = [&] {
        for (int i = 0; i < 1000; ++i) {
          Eigen::Isometry3d pose = i < 800 ? scene.pose : shift({2.05, 0, 0});
          pose.translation()[2] += 0.0005 * (i % 100) + 0.1 * (i / 100 % 2);
          Budget budget;
          if (i % 7 == 0) budget.deadline = Clock::now() + 20us;
          const QueryResult result = i / 10 % 2 == 0 ? query.leaf_pairs(pose, out, budget)
                                                     : query.contacts(pose, points, budget);
          kept += result.found == Found::kKept ? 1 : 0;
          clear += result.found == Found::kClear ? 1 : 0;
        }
      };
      // A second worker that runs late makes fewer caches in time.
      EXPECT_EQ(allocations_of([&] {
                  do {
                    go();
                  } while (!enough());
                }),
                0u);
    }
  }
}

// The first pose lays the body on itself, so that whole numbers decide.
TEST(Allocations, NoVerbMakesOne) {
  const SphereTree tree = triangle_tree(icosphere(3, 1), 20);
  for (const int workers : {1, 2}) {
    Query query(tree, tree, {.workers = workers, .near_pairs = 512});
    VerbRoom room(query);
    std::uint64_t tests = 0;
    const auto count = [&](const auto& result) { tests += result.sphere_tests; };
    EXPECT_EQ(allocations_of([&] {
                for (int i = 0; i < 100; ++i) {
                  for (const Budget& budget : {Budget{}, Budget{.tests = 1000}}) {
                    ask_every_verb(query, shift({0.03 * i, 0, 0}), room, budget, count);
                  }
                }
              }),
              0u);
    EXPECT_GT(tests, 1'000'000u);
  }
}

}  // namespace
}  // namespace ist::test
