#include "loop/haptics/bodies/hand_bodies.h"

#include <gtest/gtest.h>

#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr double kMesh = 1e-3;

Placement random_place(Random& random) { return {random.rotation(), random.point(-0.05, 0.05)}; }

// The place of a mesh's point, in millimetres, in the scene.
Vector3d at(const Placement& place, const Vector3d& point) {
  return place.rotation * (kMesh * point) + place.translation;
}

// A fixed body, two held ones, and one that the hand may take.
HandBodies four_bodies(Random& random, const Placement& home) {
  return HandBodies(
      kMesh, home,
      {{"fixed", random_place(random), random.point(-5, 5), 0.01},
       {"loose", random_place(random), random.point(-5, 5), 0.01, false, true},
       {"first",
        {home.rotation, home.translation - home.rotation * Vector3d(1e-3, 2e-3, 3e-3)},
        {1, 2, 3},
        0.02,
        true},
       {"second", random_place(random), random.point(-5, 5), 0.01, true, true}});
}

double placement_difference(const Placement& a, const Placement& b) {
  return (a.rotation - b.rotation).norm() + (a.translation - b.translation).norm();
}

TEST(HandBodies, HeldOnesMoveAsOneWithTheTool) {
  Random random(5);
  const Placement home = random_place(random);
  const HandBodies bodies = four_bodies(random, home);
  const Placement first = bodies.place(2, home), second = bodies.place(3, home);
  EXPECT_LT((at(first, {1, 2, 3}) - home.translation).norm(), 1e-15) << "the tool's origin";
  for (int i = 0; i < samples(20); ++i) {
    const Placement tool = random_place(random);
    const Eigen::Matrix3d turn = tool.rotation * home.rotation.transpose();
    for (const auto& [body, before] : {std::pair{2, first}, std::pair{3, second}}) {
      const Placement now = bodies.place(static_cast<std::size_t>(body), tool);
      const Placement expected{turn * before.rotation,
                               turn * (before.translation - home.translation) + tool.translation};
      EXPECT_LT(placement_difference(now, expected), 1e-14)
          << bodies.name(static_cast<std::size_t>(body));
    }
  }
}

// The query's pose, by both bodies' places in the scene.
TEST(HandBodies, FramesMapHeldToFixedMeshes) {
  Random random(6);
  const Placement home = random_place(random);
  const HandBodies bodies = four_bodies(random, home);
  for (int i = 0; i < samples(20); ++i) {
    const Placement tool = random_place(random);
    for (const std::size_t held : {2u, 3u}) {
      const Vector3d point = random.point(-5, 5);
      const Vector3d scene = at(bodies.place(held, tool), point);
      const Placement fixed = bodies.place(0, tool);
      const Vector3d expected = fixed.rotation.transpose() * (scene - fixed.translation) / kMesh;
      EXPECT_LT((bodies.frames(0, held).query_pose(tool) * point - expected).norm(), 1e-11);
    }
  }
}

TEST(HandBodies, StayWhereTheyAreWhenTheHandTakesAndReleasesThem) {
  Random random(7);
  const Placement home = random_place(random);
  HandBodies bodies = four_bodies(random, home);
  const Placement tool = random_place(random), before = bodies.place(1, tool);
  bodies.attach(1, tool);
  EXPECT_TRUE(bodies.is_held(1) && bodies.may_touch(0, 1));
  EXPECT_LT(placement_difference(bodies.place(1, tool), before), 1e-15);
  const Placement there = random_place(random), carried = bodies.place(1, there);
  EXPECT_GT(placement_difference(carried, before), 1e-3);
  bodies.release(1, there);
  EXPECT_FALSE(bodies.is_held(1));
  EXPECT_LT(placement_difference(bodies.place(1, home), carried), 1e-15)
      << "whatever the tool does";
}

TEST(HandBodies, TakenBackAChangeLeavesNoTrace) {
  Random random(8);
  const Placement home = random_place(random);
  HandBodies bodies = four_bodies(random, home);
  const Placement before = bodies.place(1, home);
  bodies.attach(1, random_place(random));
  bodies.undo(1);
  EXPECT_EQ(bodies.place(1, home).rotation, before.rotation);
  EXPECT_EQ(bodies.place(1, home).translation, before.translation);
}

TEST(HandBodies, TheHeldRadiusBoundsEveryHeldBall) {
  Random random(9);
  const Placement home = random_place(random);
  HandBodies bodies = four_bodies(random, home);
  const Placement tool = random_place(random);
  bodies.attach(1, tool);
  for (const std::size_t held : {1u, 2u, 3u}) {
    // The farthest point of the ball, seen from the tool's origin.
    const double gap = bodies.gap(0, held, tool);
    const HandBodies::Ball fixed = bodies.ball(0);
    const double centres = gap + fixed.radius + (held == 2 ? 0.02 : 0.01);
    EXPECT_LE((fixed.centre - tool.translation).norm() - centres, bodies.held_radius());
  }
  const double with = bodies.held_radius();
  bodies.release(1, tool);
  bodies.release(3, tool);
  EXPECT_NEAR(bodies.held_radius(), 0.02, 1e-15) << "of the first, about its own centre";
  EXPECT_GE(with, 0.02);
}

// A point that moves with the body goes where the drift says, to second order.
TEST(HandBodies, DriftIsTheMotionOfAScriptInAStep) {
  Random random(10);
  const Placement from = random_place(random);
  Vector6 way;
  way << 0.01, -0.02, 0.005, 0.3, 0.1, -0.2;
  HandBodies bodies(kMesh, {},
                    {{"driven", from, Vector3d::Zero(), 0.01, false, false,
                      Plan({{0, from}, {1, from.moved(way)}})}});
  const Placement tool = random_place(random);
  for (const double time : {0.0, 0.4, 0.998}) {
    bodies.set_time(time, 1e-3);
    const Placement now = bodies.place(0, tool);
    const Vector6 drift = bodies.drift(0, tool);
    bodies.set_time(time + 1e-3, 1e-3);
    const Placement next = bodies.place(0, tool);
    for (int i = 0; i < samples(5); ++i) {
      const Vector3d point = random.point(-20, 20), arm = at(now, point) - tool.translation;
      const Vector3d moved = drift.head<3>() + drift.tail<3>().cross(arm);
      EXPECT_LT((at(next, point) - at(now, point) - moved).norm(), 1e-8);
      EXPECT_GT(moved.norm(), 1e-6);
    }
  }
  bodies.set_time(2, 1e-3);
  EXPECT_EQ(bodies.drift(0, tool), Vector6(Vector6::Zero())) << "rests at its end";
}

}  // namespace
}  // namespace ist::test
