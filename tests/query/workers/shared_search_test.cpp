#include "ist/query/workers/shared_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <optional>
#include <thread>
#include <vector>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/query/workers/shared_work.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "query/test_clocks.h"
#include "query/workers/shared_query_case.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// A query with two workers, and the answer of one.
class SharedSearchThread : public SharedQueryTest {
 protected:
  bool is_right(Query& query) override { return same(ask(query, scene_.pose), expected_); }

  const Scene& scene_ = shells();
  const QueryOptions alone_ = options_of(SpherePolicy::kSlab);
  const QueryOptions shared_ = options_of(SpherePolicy::kSlab, "", 2);
  const FoundPairs expected_ = [this] {
    Query query(scene_.fixed, scene_.moving, alone_);
    return ask(query, scene_.pose);
  }();
};

TEST_F(SharedSearchThread, GivesTheAnswerOfOneWorker) {
  Query query(scene_.fixed, scene_.moving, shared_);
  int queries = 0;
  EXPECT_TRUE(ask_until(query, [&] { return ++queries >= 100 && sharing_of(query).chunks > 20; }));
  std::cout << sharing_of(query).chunks << " chunks helped in " << queries << " queries\n";
}

TEST_F(SharedSearchThread, DoesWithoutAWorkerThatStalls) {
  Query query(scene_.fixed, scene_.moving, shared_);
  for (const HandOver point : kHandOvers) {
    SCOPED_TRACE(static_cast<int>(point));
    {
      const Stall stall(point);
      ASSERT_TRUE(ask_until(query, Stall::reached));
      const std::uint64_t helped = sharing_of(query).chunks;
      for (int later = 0; later < 10; ++later) {
        ASSERT_TRUE(same(ask(query, scene_.pose), expected_));
      }
      EXPECT_EQ(sharing_of(query).chunks, helped);
    }
    ASSERT_TRUE(ask_until_helped(query));  // it works again
  }
}

// Each time it stalls it goes on in the midst of later queries.
TEST_F(SharedSearchThread, ForgetsAWorkerThatIsLate) {
  Query query(scene_.fixed, scene_.moving, shared_);
  for (int round = 0; round < 8; ++round) {
    const Stall stall(kHandOvers[round % 4]);
    ASSERT_TRUE(ask_until(query, Stall::reached));
    ASSERT_TRUE(ask_while_let_go(query, round * 50us));
  }
}

TEST_F(SharedSearchThread, IsNotDestroyedUnderAWorkerThatIsLate) {
  for (const HandOver point : kHandOvers) {
    std::optional<Query> query(std::in_place, scene_.fixed, scene_.moving, shared_);
    const Stall stall(point);
    ASSERT_TRUE(ask_until(*query, Stall::reached));
    if (point == HandOver::kSeen) {  // only a worker that has entered the search is waited for
      query.reset();
      EXPECT_FALSE(Stall::released());
    } else {
      ReleaseOnWait release;
      query.reset();
      EXPECT_TRUE(release.awaited());
    }
  }
}

TEST_F(SharedSearchThread, SeveralQueriesShareTheWorker) {
  std::atomic<std::uint64_t> helped{0};
  std::vector<std::jthread> owners;
  for (int owner = 0; owner < 3; ++owner) {
    owners.emplace_back([this, &helped] {
      Query query(scene_.fixed, scene_.moving, shared_);
      EXPECT_TRUE(ask_until(query, [&] { return sharing_of(query).chunks > 10; }));
      helped += sharing_of(query).chunks;
    });
  }
  owners.clear();
  EXPECT_GT(helped, 30u);
}

TEST_F(SharedSearchThread, WhatADeadlineCutsShortSpoilsNothing) {
  Query query(scene_.fixed, scene_.moving, shared_);
  ContactManifold points(scene_.fixed, scene_.moving, SpherePolicy::kSlab, {.margin = 2});
  int turn = 0, cut = 0;
  std::uint64_t helped = 0;  // with a deadline
  EXPECT_TRUE(ask_until(query, [&] {
    const std::uint64_t before = sharing_of(query).chunks;
    // Every other one has time enough, however slow the machine is.
    const auto time = turn % 2 == 0 ? Clock::duration((turn % 40) * 20us) : Clock::duration(1h);
    const Budget budget{.deadline = Clock::now() + time};
    cut += query.contacts(scene_.pose, points, budget).complete ? 0 : 1;
    helped += sharing_of(query).chunks - before;
    return ++turn >= 100 && helped > 20;
  }));
  EXPECT_GT(cut, 0);
}

// Whatever the frontier holds, no step is made twice.
TEST_F(SharedSearchThread, ALimitOfTestsEndsWhereOneWorkerEnds) {
  const Scene& scene = solids()[0];
  for (const std::size_t pairs : {1u, 2u, 8u, 65536u}) {
    QueryOptions options = alone_;
    options.frontier_pairs = pairs;
    Query single(scene.fixed, scene.moving, options);
    options.workers = 2;
    Query query(scene.fixed, scene.moving, options);
    for (const std::uint64_t tests : {0u, 1u, 5u, 64u, 1000u, 20'000u, 10'000'000u}) {
      const QueryResult one = single.leaf_pairs(scene.pose, {}, {.tests = tests});
      const QueryResult two = query.leaf_pairs(scene.pose, {}, {.tests = tests});
      EXPECT_LE(two.sphere_tests, std::max<std::uint64_t>(tests, 1));
      EXPECT_EQ(two.sphere_tests, one.sphere_tests);
      EXPECT_EQ(two.leaf_pairs, one.leaf_pairs);
      EXPECT_EQ(two.level, one.level);
      EXPECT_EQ(two.truncated, one.truncated);
      EXPECT_EQ(two.distance->lower, one.distance->lower);
      EXPECT_EQ(two.distance->upper, one.distance->upper);
    }
  }
}

// Poses with much work to share alternate with poses with little, and with separate bodies.
TEST_F(SharedSearchThread, PosesOfAnySizeFollowEachOther) {
  Query query(scene_.fixed, scene_.moving, shared_);
  Query single(scene_.fixed, scene_.moving, alone_);
  std::vector<std::pair<Eigen::Isometry3d, FoundPairs>> cases;
  for (const double dz : {0.0, -0.5, -1.5, -2.0, -3.0, -200.0}) {
    const Eigen::Isometry3d pose = shift({0, 0, dz});
    cases.emplace_back(pose, ask(single, pose));
  }
  EXPECT_GT(cases.front().second.result.leaf_pairs, 1000u);
  EXPECT_EQ(cases.back().second.result.sphere_tests, 1u);
  int turn = 0;
  EXPECT_TRUE(ask_until(query, [&] {
    for (const auto& [pose, answer] : cases) EXPECT_TRUE(same(ask(query, pose), answer));
    return HasFailure() || (++turn >= 20 && sharing_of(query).chunks > 10);
  }));
}

// The worker leaves chunks to the caller.
TEST_F(SharedSearchThread, FindsMoreContactsThanTheWorkerHasRoomFor) {
  BuildOptions build;
  build.voxel_size = 2.0 / 150;
  build.spheres = SpherePolicy::kSimple;
  const SphereTree ball = build_tree(icosphere(4, 1), build);
  const Eigen::Isometry3d pose = shift({build.voxel_size / 4, 0, 0});
  Query query(ball, ball, options_of(SpherePolicy::kSimple, "", 2));
  Query single(ball, ball, options_of(SpherePolicy::kSimple));
  const FoundPairs expected = ask(single, pose);
  EXPECT_GT(expected.result.leaf_pairs, 1u << 20);
  FoundPairs answer = expected;
  EXPECT_TRUE(ask_until_short_of_room(query, [&] {
    answer.leaf_pairs.assign(answer.leaf_pairs.size(), {});
    answer.result = query.leaf_pairs(pose, answer.leaf_pairs);
    return same(answer, expected);
  }));
  // A short span takes the first of them, whoever found them.
  for (const std::size_t length : {std::size_t{0}, std::size_t{1}, expected.leaf_pairs.size() / 2,
                                   expected.leaf_pairs.size() - 1}) {
    std::vector<LeafPair> first(length);
    const QueryResult result = query.leaf_pairs(pose, first);
    EXPECT_TRUE(result.truncated);
    EXPECT_EQ(result.leaf_pairs, expected.leaf_pairs.size());
    EXPECT_TRUE(std::equal(first.begin(), first.end(), expected.leaf_pairs.begin()));
  }
}

// A deadline of a search that two workers share: by how much it may be overshot, by clocks that the
// test winds.

// Counts the caller's tests between two looks at the clock. The tests of the worker do not count,
// because the caller waits for them up to the deadline only.
struct Watch {
  static Clock::time_point now() noexcept {
    EXPECT_TRUE(is_caller);
    ++looks;
    tests = pairs = 0;
    return {};
  }
  static void begin() {
    is_caller = true;
    looks = tests = pairs = most_tests = most_pairs = 0;
  }
  static void note(std::uint64_t more_tests, std::uint64_t more_pairs) {
    if (!is_caller) return;
    most_tests = std::max(most_tests, tests += more_tests);
    most_pairs = std::max(most_pairs, pairs += more_pairs);
  }
  static inline thread_local bool is_caller = false;
  static inline std::uint64_t looks, tests, pairs, most_tests, most_pairs;
};

const Kernels& real_kernels() { return select_kernels(""); }

Advanced watched_advance(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                         SearchCursor& cursor, Frontier& out, SearchScratch& scratch,
                         std::uint64_t most, Measured measured, DistanceBounds& bounds) {
  const std::size_t before = out.moving_count;
  const Advanced made =
      real_kernels().advance(step, pose, in, cursor, out, scratch, most, measured, bounds);
  Watch::note(made.tests, step.last ? out.moving_count - before : 0);
  return made;
}

Advanced watched_contacts(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                          SearchCursor& cursor, ContactAdder& out, SearchScratch& scratch,
                          std::uint64_t most, Measured measured, DistanceBounds& bounds) {
  const std::uint64_t before = out.totals.pairs + out.lanes.count;
  const Advanced made =
      real_kernels().advance_contacts(step, pose, in, cursor, out, scratch, most, measured, bounds);
  Watch::note(made.tests, out.totals.pairs + out.lanes.count - before);
  return made;
}

Kernels watched_kernels() {
  Kernels kernels = real_kernels();
  kernels.advance = watched_advance;
  kernels.advance_contacts = watched_contacts;
  return kernels;
}

class SharedDeadlineThread : public SharedQueryTest {
 protected:
  bool is_right(Query& query) override { return query.leaf_pairs(scene_.pose, {}).complete; }

  const Scene& scene_ = shells();
  const QueryOptions shared_ = options_of(SpherePolicy::kSlab, "", 2);
};

// So often as with one worker, whoever does how many of the chunks.
class WatchedSharedSearchThread : public SharedDeadlineThread {
 protected:
  // `ask` searches once, and returns how many leaf pairs there are.
  template <class Ask>
  void reads_the_clock_often_enough(const Ask& ask) {
    const std::uint64_t all = Query(scene_.fixed, scene_.moving, options_of(SpherePolicy::kSlab))
                                  .leaf_pairs(scene_.pose, {})
                                  .leaf_pairs;
    Watch::begin();
    {
      const Stall stall(HandOver::kSeen);
      EXPECT_EQ(ask(), all);  // once the caller does all chunks
    }
    int alone = 0;
    for (int i = 0; i < 20 || search_.sharing().chunks < 50; ++i) {
      const std::uint64_t before = search_.sharing().chunks;
      EXPECT_EQ(ask(), all);
      alone += search_.sharing().chunks == before ? 1 : 0;
    }
    EXPECT_LE(Watch::most_tests, 500u);  // as Budget states
    EXPECT_LE(Watch::most_pairs, 512u);
    EXPECT_GT(Watch::most_tests, 250u);
    EXPECT_GT(Watch::most_pairs, 32u);
    std::cout << search_.sharing().chunks << " chunks helped, " << alone << " searches alone, "
              << Watch::most_tests << " tests and " << Watch::most_pairs
              << " leaf pairs between two looks\n";
  }

  const SearchPlan plan_{scene_.fixed, scene_.moving, SpherePolicy::kSlab};
  const Kernels kernels_ = watched_kernels();
  ist::SharedSearch search_{plan_, kernels_, 1 << 16, 0ns};
  const SearchPose pose_ = to_float(
      *relative_pose(scene_.pose, parts_of(scene_.fixed).origin, parts_of(scene_.moving).origin),
      lengths_of(scene_.fixed, SpherePolicy::kSlab),
      lengths_of(scene_.moving, SpherePolicy::kSlab));
  const Budget budget_{.deadline = Clock::time_point(1s)};
  const ScopedBudgetClock clock_{Watch::now};
};

TEST_F(WatchedSharedSearchThread, ReadsTheClockOftenEnoughForLeafPairs) {
  std::vector<LeafPair> out(1 << 20);
  reads_the_clock_often_enough([&] {
    LeafPairSink sink(plan_, kernels_, out);
    return search_.run<PairLister>(pose_, sink, BudgetMeter(budget_), Measured::kBoth).leaf_pairs;
  });
}

TEST_F(WatchedSharedSearchThread, ReadsTheClockOftenEnoughForContacts) {
  detail::ContactReducer reducer(scene_.fixed, scene_.moving, SpherePolicy::kSlab, {});
  reads_the_clock_often_enough([&] {
    reducer.clear();
    ContactOutput sink(plan_, kernels_, pose_, reducer.adder(), reducer.leaf_sums());
    return search_.run<ContactVisitor>(pose_, sink, BudgetMeter(budget_), Measured::kUpper)
        .leaf_pairs;
  });
}

// Any look of the caller at the clock may be the first late one. The query ends there, or at the
// next look if the first one only measured the wait for the worker.
TEST_F(SharedDeadlineThread, EndsTheSearchAtTheFirstLookAfterIt) {
  const ScopedBudgetClock clock(LateClock::now);
  Query query(scene_.fixed, scene_.moving, shared_);
  ContactManifold points(scene_.fixed, scene_.moving, SpherePolicy::kSlab, {.margin = 2});
  ASSERT_TRUE(ask_until_helped(query));
  const auto ends = [&](const auto& ask) {
    int stopped = 0, within_shared = 0;
    bool complete = false;
    for (int allowed = 0; !complete && allowed < 100'000; allowed += 1 + allowed / 50) {
      const std::uint64_t before = sharing_of(query).shared;
      const QueryResult result = ask(LateClock::budget_of(allowed));
      complete = result.complete;
      EXPECT_LE(LateClock::looks, allowed + 2);
      if (complete) continue;
      ++stopped;
      within_shared += sharing_of(query).shared > before ? 1 : 0;
      EXPECT_GE(LateClock::looks, allowed + 1);
      const QueryResult again = ask(Budget{.tests = result.sphere_tests});
      EXPECT_EQ(again.sphere_tests, result.sphere_tests);
      EXPECT_EQ(again.level, result.level);
      EXPECT_EQ(again.distance->lower, result.distance->lower);
      EXPECT_EQ(again.distance->upper, result.distance->upper);
    }
    EXPECT_TRUE(complete);
    EXPECT_GT(stopped, 20);
    std::cout << stopped << " searches ended, " << within_shared << " of them shared\n";
    return within_shared;
  };
  std::vector<LeafPair> out(1 << 20);
  for (int round = 0, shared = 0; (round < 3 || shared < 20) && !HasFailure(); ++round) {
    shared +=
        ends([&](const Budget& budget) { return query.leaf_pairs(scene_.pose, out, budget); });
    shared +=
        ends([&](const Budget& budget) { return query.contacts(scene_.pose, points, budget); });
  }
}

}  // namespace
}  // namespace ist::test
