// A deadline of a search that two workers share: by how much it may be overshot, by clocks that the
// test winds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <vector>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/query/workers/shared_search.h"
#include "ist/query/workers/sharing.h"
#include "ist/tree/tree_parts.h"
#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "query/test_clocks.h"
#include "query/workers/shared_query_case.h"

namespace ist::test {
namespace {

// What the caller does from one look at the clock to the next. The worker's work does not count:
// nobody waits for it longer than the deadline.
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
      *relative_pose(scene_.pose, parts_of(scene_.fixed).lattice, parts_of(scene_.moving).lattice),
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

// Whichever look of the caller's is the first late one; or at the look after it, where that one
// only said how long to wait for the worker.
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
