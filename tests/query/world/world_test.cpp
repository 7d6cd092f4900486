// A world's answers: against fresh queries and brute force, over all pairs; and what they do not
// depend on.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "ist/base/error.h"
#include "ist/base/pose.h"
#include "ist/tree/tree_parts.h"
#include "query/triangles/meeting_pairs.h"
#include "query/triangles/triangle_tree.h"
#include "query/world/world_cases.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// What a fresh query of the two bodies says.
void expect_answer_of_a_query(World& world, const std::vector<PlacedTree>& bodies,
                              const WorldOptions& options, BodyPair pair, int& meeting) {
  const std::optional<Eigen::Isometry3d> pose = world.pose_of(pair.a, pair.b);
  ASSERT_TRUE(pose);
  const SphereTree &fixed = bodies[pair.a].tree, &moving = bodies[pair.b].tree;
  Query fresh(fixed, moving, options.query);
  ContactManifold manifold(fixed, moving, fresh.policy(), options.manifold);
  std::vector<LeafPair> out(1 << 18);
  const auto intersections = world.ask(kIntersects);
  const WorldPair* listed = find(intersections, pair);
  const Answer truth =
      meeting_pairs(fixed, moving, *pose).empty() ? ist::Answer::kNo : ist::Answer::kYes;
  meeting += truth == ist::Answer::kYes ? 1 : 0;
  const QueryResult leaf_pairs = fresh.leaf_pairs(*pose, {});
  if (listed == nullptr) {  // it is apart
    EXPECT_EQ(truth, ist::Answer::kNo);
    EXPECT_EQ(leaf_pairs.leaf_pairs, 0u);
    EXPECT_EQ(leaf_pairs.sphere_tests, 1u);
    EXPECT_EQ(fresh.contacts(*pose, manifold).leaf_pairs, 0u);
    return;
  }
  EXPECT_EQ(listed->answer, truth);
  const auto leaves = world.ask(leaf_pairs_in(out));
  FoundPairs expected = ask(fresh, *pose);
  const WorldPair& of_leaves = *find(leaves, pair);
  if (options.query.front_pairs > 0) {  // how much was kept shows there
    expected.result.sphere_tests = of_leaves.sphere_tests;
  }
  ASSERT_LE(of_leaves.first + of_leaves.written, out.size());
  const auto first = out.begin() + static_cast<std::ptrdiff_t>(of_leaves.first);
  EXPECT_TRUE(same({{.status = of_leaves.status,
                     .complete = of_leaves.complete,
                     .truncated = of_leaves.truncated,
                     .level = of_leaves.level,
                     .leaf_pairs = of_leaves.found,
                     .sphere_tests = of_leaves.sphere_tests,
                     .pad = of_leaves.pad},
                    {first, first + static_cast<std::ptrdiff_t>(of_leaves.written)}},
                   expected));
  const auto felt = world.ask(kContacts);
  const WorldPair& of_contacts = *find(felt, pair);
  EXPECT_EQ(of_contacts.found, fresh.contacts(*pose, manifold).leaf_pairs);
  ASSERT_NE(of_contacts.manifold, nullptr);
  EXPECT_EQ(of_contacts.manifold, world.manifold(pair.b, pair.a));
  EXPECT_EQ(of_contacts.manifold->sums().weight, manifold.sums().weight);
  EXPECT_EQ(of_contacts.manifold->sums().spring.torque, manifold.sums().spring.torque);
  EXPECT_EQ(of_contacts.manifold->points().size(), manifold.points().size());
}

TEST(World, AnswersAsAQueryOfEachPair) {
  int meeting = 0;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{6}) && !::testing::Test::HasFailure();
       ++seed) {
    Random random(seed);
    const std::vector<PlacedTree> bodies = scattered(random, 8, 4);
    WorldOptions options = small_world();
    options.manifold.margin = 2;
    options.manifold.reach = seed % 2 == 0 ? 0 : 1;
    options.query.front_pairs = seed % 3 == 0 ? 1000 : 0;
    World world = world_of(bodies, options);
    for (BodyIndex a = 0; a < 8; ++a) {
      for (BodyIndex b = a + 1; b < 8; ++b) {
        SCOPED_TRACE(std::to_string(seed) + ": " + std::to_string(a) + ", " + std::to_string(b));
        expect_answer_of_a_query(world, bodies, options, {a, b}, meeting);
      }
    }
  }
  EXPECT_GT(meeting, least(10, 0));
}

// All but leaf pairs and contacts, whether the bodies of a pair have voxels or not.
TEST(World, AnswersWithoutVoxels) {
  Random random(4);
  std::vector<PlacedTree> bodies = scattered(random, 8, 1.5);
  World voxels = world_of(bodies);
  for (std::size_t i = 0; i < bodies.size(); i += 2) {
    bodies[i].tree = build_tree(*bodies[i].tree.triangles());
  }
  World world = world_of(bodies);
  EXPECT_LE(world.bytes(), voxels.bytes());
  std::vector<TrianglePair> pairs(1 << 16), wanted(1 << 16);
  std::size_t met = 0;
  for (const WorldPair& of_voxels : voxels.ask(kIntersects).pairs) {
    if (of_voxels.answer != Answer::kYes) continue;
    ++met;
    const WorldAnswer touching = world.ask(kIntersects);
    ASSERT_NE(find(touching, of_voxels.bodies), nullptr);
    EXPECT_EQ(find(touching, of_voxels.bodies)->answer, Answer::kYes);
  }
  EXPECT_GT(met, 0u);
  const auto count = [](const WorldAnswer& answer) {
    std::uint64_t sum = 0;
    for (const WorldPair& pair : answer.pairs) sum += pair.found;
    return sum;
  };
  EXPECT_EQ(count(world.ask(triangle_pairs_in(pairs))),
            count(voxels.ask(triangle_pairs_in(wanted))));
  const WorldDistance least = world.distance(1e-3), of_voxels = voxels.distance(1e-3);
  EXPECT_LE(least.distance.lower, of_voxels.distance.upper);
  EXPECT_GE(least.distance.upper, of_voxels.distance.lower);

  std::vector<LeafPair> leaves(1 << 16);
  for (const WorldQuestion& question : {kContacts, leaf_pairs_in(leaves)}) {
    const WorldAnswer answer = world.ask(question);
    EXPECT_EQ(answer.status, QueryStatus::kDone);
    EXPECT_FALSE(answer.complete);
    for (const WorldPair& pair : answer.pairs) {
      const bool both = pair.bodies.a % 2 == 1 && pair.bodies.b % 2 == 1;
      EXPECT_EQ(pair.status, both ? QueryStatus::kDone : QueryStatus::kNoVoxels);
      EXPECT_EQ(pair.complete, both);
      if (both) continue;
      EXPECT_EQ(pair.found, 0u);
      EXPECT_EQ(pair.manifold, nullptr);
      EXPECT_EQ(world.manifold(pair.bodies.a, pair.bodies.b), nullptr);
    }
  }
}

TEST(World, SaysHowFarThePosesOfAPairWere) {
  Random random(9);
  std::vector<PlacedTree> bodies = scattered(random, 3, 1);
  for (PlacedTree& body : bodies) body.pose = shift({0, 0, 0});
  World world = world_of(bodies);
  Eigen::Isometry3d rough = bodies[1].pose;
  rough(0, 1) = 3e-4;
  EXPECT_EQ(world.set_pose(1, rough), QueryStatus::kDone);
  const auto expect = [&](const auto& answer) {
    ASSERT_EQ(answer.pairs.size(), 3u);
    for (const auto& pair : answer.pairs) {
      const bool has_it = pair.bodies.a == 1 || pair.bodies.b == 1;
      EXPECT_EQ(pair.rotation_error, has_it ? rotation_error(rough) : 0);
    }
  };
  expect(world.ask(kIntersects));
  expect(world.ask(kIntersects, {.tests = 0}));
  expect(world.ask(kContacts));
  expect(world.ask(distance_within(0.1)));
  expect(world.ask(triangle_pairs_in({})));
  expect(world.ask(leaf_pairs_in({})));
  expect(world.distance(0));
}

TEST(World, ListsPairsInOrder) {
  Random random(1);
  const std::vector<PlacedTree> bodies = scattered(random, 20, 6);
  World world = world_of(bodies);
  const auto near = world.ask(kNear);
  ASSERT_GT(near.pairs.size(), 20u);
  EXPECT_LT(near.pairs.size(), 190u);
  EXPECT_EQ(near.near_pairs, near.pairs.size());
  EXPECT_TRUE(
      std::is_sorted(near.pairs.begin(), near.pairs.end(),
                     [](const WorldPair& x, const WorldPair& y) { return x.bodies < y.bodies; }));
  for (const WorldPair& pair : near.pairs) EXPECT_LT(pair.bodies.a, pair.bodies.b);
}

// A world that has moved about answers as one that was just made, in the same order.
TEST(World, DependsOnNoEarlierPose) {
  Random random(2);
  const std::vector<PlacedTree> bodies = scattered(random, 16, 3);
  for (const std::size_t near_pairs : {kAllPairs, std::size_t{20}}) {
    WorldOptions options = small_world();
    World moved_about = world_of(bodies, options);
    moved_about.reserve(near_pairs);
    for (int tick = 0; tick < 40; ++tick) {
      for (BodyIndex body = 0; body < 16; ++body) {
        // Along one axis after the other, so that bodies pass each other.
        Eigen::Vector3d to = random.point(0, 7);
        if (tick % 2 == 0) to[tick / 2 % 3] *= 10;
        moved_about.set_pose(body, pose_of(random.rotation(), to));
      }
      static_cast<void>(moved_about.ask(kIntersects));
    }
    for (BodyIndex body = 0; body < 16; ++body) moved_about.set_pose(body, bodies[body].pose);
    World fresh = world_of(bodies, options);
    fresh.reserve(near_pairs);
    const WorldAnswers expected = answers_of(fresh);
    EXPECT_GT(expected.pairs.size(), 10u);
    EXPECT_EQ(answers_of(moved_about), expected);
  }
}

// The order of adding decides which body is the fixed one, and nothing else.
TEST(World, PermutesItsAnswersWithItsBodies) {
  Random random(3);
  const std::vector<PlacedTree> bodies = scattered(random, 14, 7);
  World world = world_of(bodies);
  const WorldAnswers expected = answers_of(world);
  for (int turn = 0; turn < samples(4); ++turn) {
    std::vector<BodyIndex> at(bodies.size());  // by the new number, the old one
    std::iota(at.begin(), at.end(), BodyIndex{0});
    for (std::size_t i = at.size(); i > 1; --i) std::swap(at[i - 1], at[random.below(i)]);
    std::vector<PlacedTree> permuted;
    for (const BodyIndex old : at) permuted.push_back(bodies[old]);
    World other = world_of(permuted);
    WorldAnswers found = answers_of(other);
    for (auto& pair : found.pairs) {
      pair.bodies = {at[pair.bodies.a], at[pair.bodies.b]};
      if (pair.bodies.a < pair.bodies.b) continue;
      pair.bodies = {pair.bodies.b, pair.bodies.a};
      for (LeafPair& leaves : pair.leaf_pairs) std::swap(leaves.fixed, leaves.moving);
      for (TrianglePair& triangles : pair.triangles) std::swap(triangles.fixed, triangles.moving);
      std::sort(pair.leaf_pairs.begin(), pair.leaf_pairs.end());
      std::sort(pair.triangles.begin(), pair.triangles.end());
    }
    std::sort(found.pairs.begin(), found.pairs.end(),
              [](const auto& x, const auto& y) { return x.bodies < y.bodies; });
    ASSERT_EQ(found.pairs.size(), expected.pairs.size());
    for (std::size_t k = 0; k < found.pairs.size(); ++k) {
      EXPECT_EQ(found.pairs[k].bodies, expected.pairs[k].bodies);
      EXPECT_EQ(found.pairs[k].answer, expected.pairs[k].answer);
      EXPECT_EQ(found.pairs[k].leaf_pairs, expected.pairs[k].leaf_pairs);
      EXPECT_EQ(found.pairs[k].triangles, expected.pairs[k].triangles);
      EXPECT_NEAR(found.pairs[k].lower, expected.pairs[k].lower, 1e-12);
    }
  }
}

// Wherever the bodies lie together, they have the same answers.
TEST(World, DoesNotDependOnThePlace) {
  Random random(4);
  std::vector<PlacedTree> bodies = scattered(random, 10, 3);
  // On a grid, so that a shift is exact.
  for (PlacedTree& body : bodies) {
    body.pose = pose_of(quarter_turns()[random.below(24U)], random.point_on_grid(0, 3, 0x1p-10));
  }
  World here = world_of(bodies);
  const WorldAnswers expected = answers_of(here);
  for (PlacedTree& body : bodies) body.pose.translation() += Eigen::Vector3d(0x1p40, -0x1p38, 3);
  World there = world_of(bodies);
  EXPECT_GT(expected.pairs.size(), 5u);
  EXPECT_EQ(answers_of(there), expected);
}

TEST(World, GivesTheStatusOfAPoseToItsPairsAlone) {
  Random random(5);
  const std::vector<PlacedTree> bodies = scattered(random, 8, 4);
  World world = world_of(bodies);
  const WorldAnswers before = answers_of(world);
  Eigen::Isometry3d bad = bodies[3].pose;
  bad.translation()[1] = kNan;
  EXPECT_EQ(world.set_pose(3, bad), QueryStatus::kInvalidPose);
  EXPECT_EQ(world.set_pose(3, bad), QueryStatus::kInvalidPose);
  EXPECT_FALSE(world.pose_of(0, 3));
  const auto is_of_3 = [](BodyPair pair) { return pair.a == 3 || pair.b == 3; };
  const auto answer = world.ask(kIntersects);
  EXPECT_EQ(answer.status, QueryStatus::kDone);
  EXPECT_FALSE(answer.complete);
  EXPECT_EQ(std::count_if(answer.pairs.begin(), answer.pairs.end(),
                          [&](const auto& pair) { return is_of_3(pair.bodies); }),
            7);
  WorldAnswers after = answers_of(world), others = before;
  for (const auto& pair : after.pairs) {
    EXPECT_EQ(pair.status, is_of_3(pair.bodies) ? QueryStatus::kInvalidPose : QueryStatus::kDone);
  }
  for (const WorldPair& pair : world.ask(kIntersects).pairs) {
    EXPECT_EQ(pair.answer == ist::Answer::kUnknown, is_of_3(pair.bodies));
  }
  for (const auto& pair : world.ask(kContacts).pairs) {
    EXPECT_EQ(pair.status == QueryStatus::kDone, !is_of_3(pair.bodies));
    EXPECT_EQ(pair.manifold == nullptr, is_of_3(pair.bodies));
  }
  std::erase_if(after.pairs, [&](const auto& pair) { return is_of_3(pair.bodies); });
  std::erase_if(others.pairs, [&](const auto& pair) { return is_of_3(pair.bodies); });
  EXPECT_FALSE(others.pairs.empty());
  EXPECT_EQ(after, others);
  // Two of them: each pair is listed once. Then all is well again.
  world.set_pose(6, bad);
  const auto near = world.ask(kNear);
  EXPECT_EQ(std::count_if(near.pairs.begin(), near.pairs.end(),
                          [](const WorldPair& pair) { return pair.status != QueryStatus::kDone; }),
            13);
  world.set_pose(6, bodies[6].pose);
  EXPECT_EQ(world.set_pose(3, bodies[3].pose), QueryStatus::kDone);
  EXPECT_EQ(answers_of(world), before);
}

// Poses at the end of what a double holds: nothing is missed, and nothing hangs.
TEST(World, HoldsPosesFarAway) {
  const SphereTree ball = triangle_tree(icosphere(2, 1), 8);
  World world(small_world());
  for (const double x : {1e308, 1e308, -1e308, 0.0, 1.5, 1e200, 1e154})
    world.add(ball, shift({x, x, x}));
  world.reserve();
  const auto answer = world.ask(kIntersects);
  ASSERT_NE(find(answer, {0, 1}), nullptr);
  EXPECT_EQ(find(answer, {0, 1})->status, QueryStatus::kDone);
  EXPECT_EQ(find(answer, {3, 4}), nullptr);
  EXPECT_EQ(answer.pairs.size(), 1u);
  const WorldDistance least = world.distance(0.1);
  EXPECT_EQ(least.distance.upper, 0);
  // Farther apart than a double tells.
  World ends(small_world());
  for (const double x : {1e308, -1e308}) ends.add(ball, shift({x, x, x}));
  ends.reserve();
  EXPECT_TRUE(ends.ask(kIntersects).pairs.empty());
  const WorldDistance far = ends.distance(0.1);
  EXPECT_EQ(far.status, QueryStatus::kDone);
  EXPECT_GT(far.distance.lower, 1e307);
}

TEST(World, NeverLooksAtAPairThatIsIgnored) {
  const SphereTree ball = triangle_tree(icosphere(2, 1), 8);
  World world(small_world());
  for (const double x : {0.0, 0.5, 1.0}) world.add(ball, shift({x, 0, 0}));
  world.ignore(2, 0);
  world.reserve();
  EXPECT_EQ(find(world.ask(kIntersects), {0, 2}), nullptr);
  EXPECT_EQ(world.ask(kIntersects).pairs.size(), 2u);
  world.ignore(0, 1);  // after reserve() too
  EXPECT_EQ(world.ask(kIntersects).pairs.size(), 1u);
  world.ignore(1, 2);
  Eigen::Isometry3d bad = shift({kNan, 0, 0});
  world.set_pose(1, bad);
  EXPECT_TRUE(world.ask(kIntersects).pairs.empty());
  EXPECT_TRUE(world.ask(kIntersects).complete);
  const WorldDistance none = world.distance(0.1);
  EXPECT_EQ(none.status, QueryStatus::kDone);
  EXPECT_TRUE(none.complete);
  EXPECT_FALSE(none.nearest);
  EXPECT_EQ(none.distance.lower, std::numeric_limits<double>::max());
}

TEST(World, AsksNothingBeforeItIsReservedFor) {
  const SphereTree ball = triangle_tree(icosphere(2, 1), 8);
  World world(small_world());
  EXPECT_EQ(world.ask(kIntersects).status, QueryStatus::kNotPrepared);
  for (const double x : {0.0, 1.5, 3.0}) world.add(ball, shift({x, 0, 0}));
  EXPECT_EQ(world.ask(kNear).status, QueryStatus::kNotPrepared);
  EXPECT_EQ(world.distance(0.1).status, QueryStatus::kNotPrepared);
  EXPECT_EQ(world.distance(0.1).distance.upper, HUGE_VAL);
  EXPECT_STREQ(to_string(QueryStatus::kNotPrepared), "not-prepared");
  world.reserve();
  EXPECT_TRUE(world.ask(kIntersects).complete);
  EXPECT_EQ(world.ask(kIntersects).pairs[1].answer, ist::Answer::kYes);
  world.add(ball, shift({9, 0, 0}));
  EXPECT_EQ(world.ask(kIntersects).status, QueryStatus::kNotPrepared);
}

TEST(World, LeavesPairsUnknownBeyondThoseReserved) {
  const SphereTree ball = triangle_tree(icosphere(2, 1), 8);
  World world(small_world());
  for (int i = 0; i < 6; ++i) world.add(ball, shift({0.1 * i, 0, 0}));
  world.reserve(4);
  const auto answer = world.ask(kIntersects);
  EXPECT_EQ(answer.status, QueryStatus::kDone);
  EXPECT_TRUE(answer.truncated);
  EXPECT_FALSE(answer.complete);
  EXPECT_EQ(answer.near_pairs, 15u);
  std::vector<BodyPair> listed;
  for (const auto& pair : answer.pairs) {
    listed.push_back(pair.bodies);
    EXPECT_EQ(pair.answer, ist::Answer::kYes);
  }
  EXPECT_EQ(listed, (std::vector<BodyPair>{{0, 1}, {0, 2}, {0, 3}, {0, 4}}));
  EXPECT_NE(world.ask(kContacts).pairs[3].manifold, nullptr);
  EXPECT_NE(world.manifold(4, 0), nullptr);
  EXPECT_EQ(world.manifold(0, 5), nullptr);
  // Pairs that are not listed count in the distance all the same.
  EXPECT_EQ(world.distance(0.1).distance.lower, 0);
  // The count of near pairs says for how many to reserve.
  world.reserve(answer.near_pairs);
  EXPECT_TRUE(world.ask(kIntersects).complete);
  EXPECT_EQ(world.ask(kIntersects).pairs.size(), 15u);
}

// One query serves pairs of all sizes, one after the other, and each pair has its own witnesses.
TEST(World, AnswersAsEachPairsOwnQueryAlongAMotion) {
  Random random(11);
  std::vector<PlacedTree> bodies = scattered(random, 6, 3);
  bodies.push_back({triangle_tree(icosphere(4, 1), 30), shift({1, 1, 1})});
  bodies.push_back({without_triangles(triangle_tree(icosphere(2, 1), 12)), shift({2, 1, 1})});
  for (int i = 2; i < 5; ++i) {
    bodies.push_back({triangle_tree(icosphere(3, 1), 20), shift(2.02 * Eigen::Vector3d(i, 1, 1))});
  }
  WorldOptions options = small_world();
  options.query.front_pairs = 4000;
  options.pair_caches = 3;
  World world = world_of(bodies, options);
  const auto count = static_cast<BodyIndex>(bodies.size());
  std::map<BodyPair, Query> queries;
  for (BodyIndex a = 0; a < count; ++a) {
    for (BodyIndex b = a + 1; b < count; ++b) {
      queries.try_emplace({a, b}, bodies[a].tree, bodies[b].tree, options.query);
    }
  }
  std::vector<LeafPair> out(1 << 18), of_one(1 << 18);
  int kept = 0;
  for (int tick = 0; tick < samples(400) && !::testing::Test::HasFailure(); ++tick) {
    // A body has no pose for a few ticks, so other pairs get the pair caches of its pairs.
    const auto away = static_cast<BodyIndex>(tick / 4) % (2 * count);
    for (BodyIndex body = 0; body < count; ++body) {
      bodies[body].pose.translation() += random.point(-0.005, 0.005);
      world.set_pose(body, body == away ? shift({kNan, 0, 0}) : bodies[body].pose);
    }
    for (const WorldPair& pair : world.ask(kIntersects).pairs) {
      if (pair.status != QueryStatus::kDone) continue;
      Query& query = queries.at(pair.bodies);
      const IntersectionResult own = query.intersects(*world.pose_of(pair.bodies.a, pair.bodies.b));
      EXPECT_EQ(pair.answer, own.answer);
    }
    const double tolerance = tick % 2 == 0 ? 1e-3 : 0.2;
    for (const WorldPair& pair : world.ask(distance_within(tolerance)).pairs) {
      if (pair.status != QueryStatus::kDone) continue;
      const DistanceResult own =
          queries.at(pair.bodies).distance(*world.pose_of(pair.bodies.a, pair.bodies.b), tolerance);
      EXPECT_EQ(pair.complete, own.complete);
      EXPECT_EQ(pair.distance.lower, own.distance.lower);
      EXPECT_EQ(pair.distance.upper, own.distance.upper);
    }
    for (const WorldPair& pair : world.ask(leaf_pairs_in(out)).pairs) {
      if (pair.status != QueryStatus::kDone) continue;
      const QueryResult own =
          queries.at(pair.bodies).leaf_pairs(*world.pose_of(pair.bodies.a, pair.bodies.b), of_one);
      ASSERT_EQ(pair.written, own.leaf_pairs);
      EXPECT_TRUE(std::equal(of_one.begin(),
                             of_one.begin() + static_cast<std::ptrdiff_t>(pair.written),
                             out.begin() + static_cast<std::ptrdiff_t>(pair.first)));
      kept += pair.way != Found::kFresh ? 1 : 0;
    }
  }
  EXPECT_GT(kept, least(20, 0));
}

// A plate has the depth and the voxel size of a ball, and fewer nodes.
TEST(World, HasRoomForTheTreeWithTheMostNodes) {
  const SphereTree plate = triangle_tree(box({-1, -1, -0.01}, {1, 1, 0.01}), 32),
                   ball = triangle_tree(icosphere(3, 1), 32);
  ASSERT_EQ(plate.depth(), ball.depth());
  ASSERT_EQ(plate.voxel_size(), ball.voxel_size());
  World world;
  world.add(plate, shift({0, 0, 5}));
  world.add(ball, shift({0, 0, 0}));
  world.add(ball, shift({0.2, 0.1, 0}));
  world.add(plate, shift({0, 0, -5}));
  world.reserve();
  std::vector<LeafPair> out(1 << 20), own(1 << 20);
  const WorldAnswer answer = world.ask(leaf_pairs_in(out));
  ASSERT_EQ(answer.pairs.size(), 1u);
  EXPECT_EQ(answer.pairs[0].written,
            Query(ball, ball).leaf_pairs(shift({0.2, 0.1, 0}), own).leaf_pairs);
}

// The memory grows with the pairs that are near at a time, and not with all pairs.
TEST(World, HoldsAThousandBallsOfOneTree) {
  const SphereTree ball = triangle_tree(icosphere(3, 1), 12);
  World world;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d place(i % 10, i / 10 % 10, i / 100);
    world.add(ball, shift(1.99 * place));
  }
  world.reserve(1 << 13);
  EXPECT_EQ(world.bytes(), world.bytes_needed(1 << 13));
  EXPECT_LT(world.bytes(), std::uint64_t{100} << 20);
  const WorldAnswer answer = world.ask(kIntersects);
  EXPECT_TRUE(answer.complete);
  EXPECT_GE(answer.pairs.size(), 2700u);  // each with its neighbours along the axes
  const std::uint64_t touching = static_cast<std::uint64_t>(
      std::count_if(answer.pairs.begin(), answer.pairs.end(),
                    [](const WorldPair& pair) { return pair.answer == ist::Answer::kYes; }));
  EXPECT_EQ(touching, 2700u);
}

TEST(World, HoldsTheMostBodies) {
  const SphereTree ball = triangle_tree(icosphere(1, 1), 4);
  WorldOptions options = small_world();
  options.manifold.points = 0;
  World world(options);
  for (BodyIndex i = 0; i < kMostBodies; ++i) world.add(ball, shift({3.0 * i, 0, 0}));
  EXPECT_THROW(world.add(ball), Error);
  world.reserve(kMostBodies);
  EXPECT_LT(world.bytes(), std::uint64_t{16} << 20);
  EXPECT_TRUE(world.ask(kIntersects).pairs.empty());
  EXPECT_NEAR(world.distance(0.1).distance.lower, 1, 0.2);
}

TEST(World, ReachesFartherWhereItIsAskedTo) {
  const SphereTree ball = triangle_tree(icosphere(2, 1), 8);
  for (const double reach : {0.0, 3.0}) {
    WorldOptions options = small_world();
    options.reach = reach;
    World world(options);
    world.add(ball);
    world.add(ball, shift({4, 0, 0}));
    world.reserve();
    const auto answer = world.ask(distance_within(1e-3));
    ASSERT_EQ(answer.pairs.size(), reach > 0 ? 1u : 0u);
    if (reach == 0) continue;
    EXPECT_NEAR(answer.pairs[0].distance.lower, 2, 0.2);
    EXPECT_GT(answer.pairs[0].roots.lower, 1);
    EXPECT_LE(answer.pairs[0].roots.lower, answer.pairs[0].distance.lower);
  }
}

}  // namespace
}  // namespace ist::test
