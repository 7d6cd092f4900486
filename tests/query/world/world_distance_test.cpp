#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "ist/mesh/nearest_point.h"
#include "ist/tree/tree_parts.h"
#include "query/test_clocks.h"
#include "query/triangles/mesh_distance.h"
#include "query/triangles/triangle_tree.h"
#include "query/world/world_cases.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// The certified distance of a world, against the exact minimum over all pairs of triangles.

constexpr double kRounding = 1e-6;

// The true distance of each pair, by brute force.
double distance_of(const World& world, const std::vector<PlacedTree>& bodies, BodyPair pair) {
  return mesh_distance(parts_of(bodies[pair.a].tree).triangles->mesh,
                       parts_of(bodies[pair.b].tree).triangles->mesh,
                       *world.pose_of(pair.a, pair.b));
}

TEST(WorldDistance, HoldsTheLeastOfAllPairs) {
  int touching = 0, apart = 0, unasked = 0;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{30}) && !::testing::Test::HasFailure();
       ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const double extent = seed % 3 == 0 ? 3 : 20;
    const std::vector<PlacedTree> bodies = scattered(random, 7, extent);
    World world = world_of(bodies);
    if (seed % 4 == 0) world.ignore(0, 1);
    double truth = HUGE_VAL;
    for (BodyIndex a = 0; a < 7; ++a) {
      for (BodyIndex b = a + 1; b < 7; ++b) {
        if (seed % 4 == 0 && BodyPair{a, b} == BodyPair{0, 1}) continue;
        truth = std::min(truth, distance_of(world, bodies, {a, b}));
      }
    }
    (truth > 0 ? apart : touching) += 1;
    for (const double tolerance : {10.0, 0.1, 1e-3, 0.0}) {
      const WorldDistance found = world.distance(tolerance);
      EXPECT_EQ(found.status, QueryStatus::kDone);
      EXPECT_LE(found.distance.lower, truth + kRounding);
      EXPECT_GE(found.distance.upper, truth - kRounding);
      EXPECT_LE(found.distance.upper - found.distance.lower, tolerance + 2 * kRounding);
      EXPECT_EQ(found.complete, found.distance.upper - found.distance.lower <= tolerance);
      ASSERT_TRUE(found.nearest);
      EXPECT_LE(distance_of(world, bodies, *found.nearest), found.distance.upper + kRounding);
      for (const WorldPair& pair : found.pairs) {
        if (pair.nearest) {  // the points are in the world, as far apart as the triangles
          const NearPair& at = *pair.nearest;
          EXPECT_NEAR((at.moving_point - at.fixed_point).norm(), at.distance, kRounding);
          const Eigen::Vector3d p = bodies[pair.bodies.b].pose.inverse() * at.moving_point;
          const TriangleMesh& mesh = parts_of(bodies[pair.bodies.b].tree).triangles->mesh;
          const Triangle& t = mesh.triangles[at.triangles.moving];
          const NearestPoint on_it = nearest_on_triangle(
              {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, p);
          EXPECT_LT((on_it.point - p).norm(), kRounding);
        }
        EXPECT_LE(outside(pair.distance, distance_of(world, bodies, pair.bodies)), kRounding);
        EXPECT_LE(outside(pair.roots, distance_of(world, bodies, pair.bodies)), kRounding);
      }
      unasked += 21 - static_cast<int>(found.pairs.size());
    }
  }
  EXPECT_GT(touching, least(4, 0));
  EXPECT_GT(apart, least(10, 0));
  EXPECT_GT(unasked, least(400, 40));  // most pairs are left out by their roots
}

// With memory for a few pairs, the roots of the other pairs give the least distance.
TEST(WorldDistance, CountsPairsThatHaveNoRoom) {
  Random random(1);
  for (int turn = 0; turn < samples(20) && !::testing::Test::HasFailure(); ++turn) {
    std::vector<PlacedTree> bodies = scattered(random, 9, 4);
    World world(small_world());
    for (const auto& [tree, pose] : bodies) world.add(tree, pose);
    world.reserve(1 + static_cast<std::size_t>(turn % 2));
    const WorldDistance found = world.distance(1e-3);
    EXPECT_LE(found.pairs.size(), 2u);
    EXPECT_GE(found.pairs.size(), 1u);
    for (BodyIndex a = 0; a < 9; ++a) {
      for (BodyIndex b = a + 1; b < 9; ++b) {
        EXPECT_LE(found.distance.lower, distance_of(world, bodies, {a, b}) + kRounding);
      }
    }
  }
}

// The roots of all pairs that a budget leaves count.
TEST(WorldDistance, IsTrueHoweverEarlyABudgetEndsIt) {
  Random random(7);
  const std::vector<PlacedTree> bodies = scattered(random, 7, 9);
  World world = world_of(bodies);
  double truth = HUGE_VAL;
  for (BodyIndex a = 0; a < 7; ++a) {
    for (BodyIndex b = a + 1; b < 7; ++b) {
      truth = std::min(truth, distance_of(world, bodies, {a, b}));
    }
  }
  int early = 0;
  double width = HUGE_VAL;
  for (std::uint64_t tests = 0; tests < 4000; tests = 2 * tests + 1) {
    const WorldDistance found = world.distance(1e-4, {.tests = tests});
    EXPECT_LE(outside(found.distance, truth), kRounding);
    EXPECT_LE(found.sphere_tests, tests + found.pairs.size());
    early += found.complete ? 0 : 1;
    width = std::min(width, found.distance.upper - found.distance.lower);
  }
  EXPECT_GT(early, 3);
  EXPECT_LT(width, 2e-4);
}

TEST(WorldDistance, IsOfTheOthersWhereABodyHasNoPose) {
  const SphereTree ball = triangle_tree(icosphere(2, 1), 8);
  World world(small_world());
  for (const double x : {0.0, 3.0, 2.5}) world.add(ball, shift({x, 0, 0}));
  world.reserve();
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.matrix()(3, 3) = 2;
  world.set_pose(2, bad);
  const WorldDistance found = world.distance(0.01);
  EXPECT_EQ(found.status, QueryStatus::kInvalidPose);
  EXPECT_FALSE(found.complete);
  EXPECT_NEAR(found.distance.lower, 1, 0.1);
  EXPECT_EQ(found.nearest, (BodyPair{0, 1}));
  // An ignored pair is skipped even without a pose.
  world.ignore(0, 2);
  world.ignore(1, 2);
  EXPECT_EQ(world.distance(0.01).status, QueryStatus::kDone);
}

// One budget for a whole call of a world; and a world that is in use.

class WorldBudget : public ::testing::Test {
 protected:
  // Balls in a row, each touching the next.
  WorldBudget() : world_(small_world()) {
    for (int i = 0; i < 5; ++i) world_.add(ball_, shift({1.9 * i, 0, 0}));
    world_.reserve();
  }
  const SphereTree ball_ = triangle_tree(icosphere(3, 1), 24);
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
      // The same answer as from a fresh query with the rest of the budget.
      Query fresh(ball_, ball_, small_world().query);
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
