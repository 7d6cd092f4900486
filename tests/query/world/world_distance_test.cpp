// The certified distance of a world, against the exact minimum over all pairs of triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "ist/tree/tree_parts.h"
#include "query/triangles/mesh_distance.h"
#include "query/triangles/triangle_tree.h"
#include "query/world/world_cases.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

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

// The same with some pairs that were not prepared: they count with their roots.
TEST(WorldDistance, CountsPairsThatWereNotPrepared) {
  int wide = 0;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{20}) && !::testing::Test::HasFailure();
       ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::vector<PlacedTree> bodies = scattered(random, 6, 8);
    World world(small_world());
    for (const auto& [tree, pose] : bodies) world.add(tree, pose);
    const BodyPair some[] = {{0, 1}, {2, 3}, {1, 4}};
    world.prepare(some);
    double truth = HUGE_VAL;
    for (BodyIndex a = 0; a < 6; ++a) {
      for (BodyIndex b = a + 1; b < 6; ++b) {
        truth = std::min(truth, distance_of(world, bodies, {a, b}));
      }
    }
    const WorldDistance found = world.distance(1e-3);
    EXPECT_LE(outside(found.distance, truth), kRounding);
    wide += found.complete ? 0 : 1;
    for (const WorldPair& pair : found.pairs) {
      const bool prepared = world.query(pair.bodies.a, pair.bodies.b) != nullptr;
      EXPECT_EQ(pair.status, prepared ? QueryStatus::kDone : QueryStatus::kNotPrepared);
      if (prepared) continue;
      EXPECT_EQ(pair.distance.lower, pair.roots.lower);
      EXPECT_EQ(pair.distance.upper, pair.roots.upper);
    }
  }
  EXPECT_GT(wide, least(10, 0));
}

// With room for a few pairs alone, the others count with the least of their roots.
TEST(WorldDistance, CountsPairsThatHaveNoRoom) {
  Random random(1);
  for (int turn = 0; turn < samples(20) && !::testing::Test::HasFailure(); ++turn) {
    std::vector<PlacedTree> bodies = scattered(random, 9, 4);
    WorldOptions options = small_world();
    options.most_near = turn % 2 == 0 ? 1 : 0;
    World world(options);
    for (const auto& [tree, pose] : bodies) world.add(tree, pose);
    const BodyPair one{0, 1};
    world.prepare({&one, turn % 4 < 3 ? 1u : 0u});
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

// Of all pairs that a budget leaves, the roots.
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
  world.prepare();
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.matrix()(3, 3) = 2;
  world.set_pose(2, bad);
  const WorldDistance found = world.distance(0.01);
  EXPECT_EQ(found.status, QueryStatus::kInvalidPose);
  EXPECT_FALSE(found.complete);
  EXPECT_NEAR(found.distance.lower, 1, 0.1);
  EXPECT_EQ(found.nearest, (BodyPair{0, 1}));
  // Ignored pairs need no pose.
  world.ignore(0, 2);
  world.ignore(1, 2);
  EXPECT_EQ(world.distance(0.01).status, QueryStatus::kDone);
}

}  // namespace
}  // namespace ist::test
