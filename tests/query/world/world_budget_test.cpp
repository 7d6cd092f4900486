// One budget for a whole call of a world; and a world that is in use.
#include <gtest/gtest.h>

#include <chrono>

#include "query/test_clocks.h"
#include "query/triangles/triangle_tree.h"
#include "query/world/world_cases.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

class WorldBudget : public ::testing::Test {
 protected:
  // Balls in a row, each touching the next.
  WorldBudget() : world_(small_world()) {
    const SphereTree ball = triangle_tree(icosphere(3, 1), 24);
    for (int i = 0; i < 5; ++i) world_.add(ball, shift({1.9 * i, 0, 0}));
    world_.prepare();
  }
  World world_;
  std::vector<LeafPair> leaf_pairs_ = std::vector<LeafPair>(1 << 16);
  std::vector<TrianglePair> triangles_ = std::vector<TrianglePair>(1 << 16);
};

TEST_F(WorldBudget, OfTestsIsOneForAllPairs) {
  const auto whole = world_.ask(leaf_pairs_in(leaf_pairs_));
  ASSERT_EQ(whole.pairs.size(), 4u);
  std::uint64_t last = 0;
  for (std::uint64_t tests = 0; tests < 2 * whole.sphere_tests; tests = 3 * tests / 2 + 1) {
    const auto answer = world_.ask(leaf_pairs_in(leaf_pairs_), {.tests = tests});
    EXPECT_EQ(answer.complete, tests >= whole.sphere_tests);
    // Beyond it stand the tests of the roots.
    EXPECT_LE(answer.sphere_tests, std::max<std::uint64_t>(tests, 1) + 4);
    EXPECT_GE(answer.sphere_tests, last);
    last = answer.sphere_tests;
    std::uint64_t spent = 0;
    for (const WorldPair& pair : answer.pairs) {
      // As a fresh query with what is left.
      Query fresh(world_.query(pair.bodies.a, pair.bodies.b)->fixed(),
                  world_.query(pair.bodies.a, pair.bodies.b)->moving(), small_world().query);
      std::vector<LeafPair> out(1 << 16);
      const QueryResult expected = fresh.leaf_pairs(*world_.pose_of(pair.bodies.a, pair.bodies.b),
                                                    out, {.tests = tests - std::min(tests, spent)});
      EXPECT_EQ(pair.sphere_tests, expected.sphere_tests);
      EXPECT_EQ(pair.found, expected.leaf_pairs);
      EXPECT_EQ(pair.complete, expected.complete);
      EXPECT_EQ(pair.level, expected.level);
      spent += expected.sphere_tests;
    }
    EXPECT_EQ(spent, answer.sphere_tests);
  }
}

TEST_F(WorldBudget, OfTimeEndsTheWholeCall) {
  const ScopedBudgetClock clock(LateClock::now);
  int early = 0, reached = 0;
  for (int looks = 0; looks < 60; ++looks) {
    const auto answer = world_.ask(leaf_pairs_in(leaf_pairs_), LateClock::budget_of(looks));
    ASSERT_EQ(answer.pairs.size(), 4u);
    bool ended = false;
    for (const WorldPair& pair : answer.pairs) {
      EXPECT_EQ(pair.status, QueryStatus::kDone);
      EXPECT_FALSE(ended && pair.complete);  // nothing goes on behind the end
      ended = ended || !pair.complete;
      EXPECT_GE(pair.distance.lower, 0);
      EXPECT_LT(pair.distance.upper, 6);
      reached += pair.complete ? 1 : 0;
    }
    early += ended ? 1 : 0;
    // Once late, the clock is read once for each pair that is left, and a little by the last query.
    EXPECT_LE(LateClock::looks, looks + 8);
    const auto touch = world_.ask(kIntersects, LateClock::budget_of(0));
    for (const WorldPair& pair : touch.pairs) {
      EXPECT_EQ(pair.answer, ist::Answer::kUnknown);
      EXPECT_FALSE(pair.complete);
    }
    const auto felt = world_.ask(kContacts, LateClock::budget_of(0));
    EXPECT_EQ(felt.pairs[3].manifold, nullptr);
    EXPECT_FALSE(world_.ask(triangle_pairs_in(triangles_), LateClock::budget_of(0)).complete);
    EXPECT_FALSE(world_.ask(distance_within(1e-3), LateClock::budget_of(0)).complete);
  }
  EXPECT_GT(early, 10);
  EXPECT_GT(reached, 20);
}

// A span that is too short holds the first of the first pairs.
TEST_F(WorldBudget, AShortSpanHoldsTheFirstPairs) {
  const auto whole = world_.ask(leaf_pairs_in(leaf_pairs_));
  const std::vector<WorldPair> all(whole.pairs.begin(), whole.pairs.end());
  const std::vector<LeafPair> expected = leaf_pairs_;
  const std::size_t first = all[0].written;
  ASSERT_GT(first, 10u);
  for (const std::size_t room : {std::size_t{0}, std::size_t{3}, first, first + 1}) {
    std::vector<LeafPair> few(room);
    const auto answer = world_.ask(leaf_pairs_in(few));
    EXPECT_TRUE(std::equal(few.begin(), few.end(), expected.begin()));
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(answer.pairs[k].found, all[k].found);
      EXPECT_EQ(answer.pairs[k].truncated, answer.pairs[k].written < all[k].written);
    }
    EXPECT_EQ(answer.pairs[0].written, std::min(room, first));
  }
  const auto meeting = world_.ask(triangle_pairs_in(triangles_));
  std::vector<TrianglePair> few(meeting.pairs[0].written + 2);
  const auto part = world_.ask(triangle_pairs_in(few));
  EXPECT_FALSE(part.pairs[0].truncated);
  EXPECT_TRUE(part.pairs[1].truncated);
  EXPECT_EQ(part.pairs[1].written, 2u);
}

// Asks a world in the middle of a question, from the clock that it reads.
struct Intruder {
  static Budget::Clock::time_point now() noexcept {
    if (world != nullptr) {
      World& asked = *std::exchange(world, nullptr);
      busy = {asked.ask(kIntersects).status,
              asked.ask(kContacts).status,
              asked.ask(leaf_pairs_in({})).status,
              asked.ask(triangle_pairs_in({})).status,
              asked.ask(distance_within(1)).status,
              asked.distance(1).status,
              asked.ask(kNear).status,
              asked.set_pose(0, shift({100, 0, 0}))};
      asked.forget();
    }
    return {};
  }
  static inline World* world = nullptr;
  static inline std::vector<QueryStatus> busy;
};

TEST_F(WorldBudget, AWorldInUseSaysThatItIsBusy) {
  const auto before = world_.ask(leaf_pairs_in(leaf_pairs_)).pairs.size();
  Intruder::world = &world_;
  const ScopedBudgetClock clock(Intruder::now);
  const auto answer = world_.ask(leaf_pairs_in(leaf_pairs_),
                                 {.deadline = Budget::Clock::time_point(std::chrono::hours(1))});
  EXPECT_EQ(Intruder::busy, std::vector<QueryStatus>(8, QueryStatus::kBusy));
  EXPECT_TRUE(answer.complete);
  EXPECT_EQ(answer.pairs.size(), before);
  EXPECT_EQ(world_.ask(kIntersects).status, QueryStatus::kDone);
}

}  // namespace
}  // namespace ist::test
