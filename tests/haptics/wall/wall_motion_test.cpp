// How a tool moves by a wall: rest, certified ways, several bodies, scripts, budgets, same bits.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "haptics/wall/wall_case.h"
#include "ist/measure/first_contact.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

TriangleMesh wall_ring() { return torus(8, 3, 48, 24); }
TriangleMesh wall_ball() { return icosphere(3, 4); }

// The device closes on the ring, goes across its hole and its rim, and turns.
void slide_over_ring(WallCase& wall) {
  wall.go_at(at_mm(6, 0, 4), 20);
  wall.go_at(at_mm(0, 1, 3), 20);
  wall.go_at(at_mm(-5, 2, 3, turn_about({1, 2, 3}, 20)), 20);
  wall.hold(at_mm(-5, 2, 3, turn_about({1, 2, 3}, 20)), 100);
}

TEST(WallMotion, AtRest_ToolKeepsItsBits) {
  for (const double friction : {0.0, 0.3}) {
    WallCase wall(wall_ring(), wall_ball(), at_mm(6, 0, 8), {.friction = friction});
    slide_over_ring(wall);
    const Placement device = at_mm(-5, 2, 3, turn_about({1, 2, 3}, 20));
    wall.hold(device, 200);
    const Placement rest = wall.pose();
    for (int i = 0; i < 1000; ++i) {
      const Tick tick = wall.tick(device);
      ASSERT_EQ(tick.tool.translation, rest.translation) << i;
      ASSERT_EQ(tick.tool.rotation, rest.rotation) << i;
    }
    EXPECT_EQ(wall.held() + wall.halved(), 0);
  }
}

TEST(WallMotion, BetweenPoses_IsFree) {
  WallCase wall(wall_ring(), wall_ball(), at_mm(6, 0, 8));
  Placement before = wall.pose();
  int ways = 0, grazed = 0;
  const auto tick = [&](const Placement& device) {
    wall.tick(device);
    if (motion_between(before, wall.pose()).norm() > 0) {
      ++ways;
      const FirstContact way =
          first_contact(wall.judge(0), wall.judged(0, before), wall.judged(0, wall.pose()), 1e-5);
      EXPECT_EQ(way.status, FirstContact::Status::kNone) << to_string(way.status);
      grazed += way.grazed;
    }
    before = wall.pose();
  };
  for (int i = 0; i < 200; ++i) tick(at_mm(6, 0, 8 - 0.02 * i));
  for (int i = 0; i < 300; ++i) tick(at_mm(6 - 0.03 * i, 0.01 * i, 4));
  EXPECT_GT(ways, 300);
  EXPECT_EQ(grazed, 0);
}

// The device jumps, rushes and turns at random, often to inside the fixed body.
TEST(WallMotion, RandomDevice_NeverMeets) {
  const TriangleMesh fixed[] = {wall_ring(), fine_box({-5, -5, -5}, {5, 5, 5}, 5),
                                box({-10, -10, -0.005}, {10, 10, 0.005})};
  const TriangleMesh held[] = {icosphere(2, 3), torus(3, 1, 24, 12), box({-2, -1, -3}, {2, 1, 3})};
  Random random(1);
  int ticks = 0, held_ticks = 0;
  for (const TriangleMesh& of : fixed) {
    for (const TriangleMesh& tool : held) {
      Placement device = at_mm(0, 0, 18, random.rotation());
      WallCase wall(of, tool, device, {.friction = random.below(2) == 0 ? 0 : 0.3});
      const int rounds = samples(5);
      for (int round = 0; round < rounds; ++round) {
        const Vector3d to = random.point(-8, 8);
        Vector6 turn = Vector6::Zero();
        turn.tail<3>() = 0.5 * random.direction();
        device = {device.moved(turn).rotation, 1e-3 * to};
        wall.go(device, round % 2 == 0 ? 1 : 60);
        wall.hold(device, 40);
        ticks += round % 2 == 0 ? 41 : 100;
      }
      held_ticks += wall.held() + wall.halved();
    }
  }
  EXPECT_LE(1000 * held_ticks, ticks) << "at most a thousandth is held or halved";
}

// Sums the motions that it is told.
struct SumOfMotions : Effect {
  explicit SumOfMotions(Vector6& to) : sum(to) {}
  [[nodiscard]] std::string_view name() const noexcept override { return "sum"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override { return {}; }
  void respond(const EffectInput&, const Vector6&, Response&) const noexcept override {}
  void advance(const EffectInput&, const Vector6& motion) noexcept override { sum += motion; }
  Vector6& sum;
};

// The device rushes into a plate and out, so that the trust cuts most steps.
TEST(WallMotion, EffectsAdvance_ByTheMotionsMade) {
  Vector6 sum = Vector6::Zero();
  const Placement start = at_mm(0, 0, 6);
  WallCase wall({{wall_plate()}}, wall_ball(), start, {}, std::make_unique<SumOfMotions>(sum));
  for (const Placement& device : {at_mm(3, 1, 0), at_mm(0, 0, 5)}) {
    wall.go_at(device, 200);
    EXPECT_LT((start.translation + sum.head<3>() - wall.pose().translation).norm(), 1e-9);
  }
}

// Two plates make a corner. The ball presses both, and one problem holds the bounds of both.
TEST(WallMotion, TwoBodies_HoldTheToolInTheirCorner) {
  const TriangleMesh side = box({-20, -22, -20}, {20, -20, 20});
  WallCase wall({{wall_plate()}, {side}}, wall_ball(), at_mm(0, -14, 6));
  wall.go_at(at_mm(0, -17, 2), 10);
  const Tick tick = wall.hold(at_mm(0, -17, 2), 500);
  Vector3d of[2] = {Vector3d::Zero(), Vector3d::Zero()};
  for (const ContactPoint& at : tick.points) {
    ASSERT_LT(at.fixed, 2U);
    EXPECT_EQ(at.held, 2U);
    of[at.fixed] += at.force;
  }
  EXPECT_NEAR(of[0].z(), 2.005, 1e-6) << "the ball has a vertex on each axis";
  EXPECT_NEAR(of[1].y(), 1.005, 1e-6);
  EXPECT_LT(std::abs(of[0].y()) + std::abs(of[1].z()), 1e-9);
}

Plan moves_straight(const Vector3d& from, const Vector3d& to, double seconds) {
  return Plan({{0, at_mm(from.x(), from.y(), from.z())}, {seconds, at_mm(to.x(), to.y(), to.z())}});
}

// A plate rises into the tool while the device rests.
TEST(WallMotion, ScriptIntoTool_PushesTheTool) {
  for (const double speed : {1.0, 10.0, 50.0}) {  // mm/s
    WallCase wall({{wall_plate(), moves_straight({0, 0, -5}, {0, 0, -2}, 3 / speed)}}, wall_ball(),
                  at_mm(0, 0, 0));
    const Tick tick = wall.hold(at_mm(0, 0, 0), static_cast<int>(3000 / speed) + 300);
    EXPECT_NEAR(1e3 * wall.fixed_pose(0).translation.z(), -2, 1e-9);
    EXPECT_NEAR(wall.tool().z(), 2.005, 1e-6);
    EXPECT_NEAR(tick.wrench[2], 2.005, 1e-6);
    EXPECT_EQ(wall.held(), 0);
  }
}

// A bar turns into the tool and wipes it aside.
TEST(WallMotion, ScriptTurnsIntoTool_WipesItAside) {
  const TriangleMesh bar = box({-20, -1, -3}, {20, 1, 3});
  const Eigen::Matrix3d quarter = turn_about(Vector3d::UnitZ(), 60);
  const Plan turns({{0, {}}, {0.5, {quarter, Vector3d::Zero()}}});
  WallCase wall({{bar, turns}}, wall_ball(), at_mm(10, 6, 0));
  wall.hold(at_mm(10, 6, 0), 1500);
  const Placement turned = wall.fixed_pose(0);
  EXPECT_LT((turned.rotation - quarter).norm(), 1e-9) << "it has come to its end";
  const double side = (turned.rotation.transpose() * wall.tool()).y();
  EXPECT_GT(side, 1 + 3.9) << "the tool is on the side where it was";
  EXPECT_LT(wall.gap(), 0.006);
  EXPECT_EQ(wall.held(), 0);
}

// A slope of 10 degrees comes down on a ball on a plate. The ball must go aside by 5.7 times its
// way.
TEST(WallMotion, ScriptSqueezesTool_KeepsTheTrust) {
  const TriangleMesh slope = turned(box({-30, -20, 0}, {30, 20, 2}), turn_about({0, 1, 0}, 10));
  const Plan down = moves_straight({0, 0, 9}, {0, 0, 6.5}, 0.1);
  WallCase wall({{wall_plate()}, {slope, down}}, wall_ball(), at_mm(0, 0, 4.01));
  wall.hold(at_mm(0, 0, 4.01), 1000);
  EXPECT_NEAR(1e3 * wall.fixed_pose(1).translation.z(), 6.5, 1e-9) << "it has come to its end";
  EXPECT_LT(wall.tool().x(), -5);
  EXPECT_EQ(wall.held(), 0);
}

// A ball on a plate, and 0.05 mm beside a post.
TEST(WallMotion, DistanceOfTick_IsTheLeastOfAllBodies) {
  const TriangleMesh post = box({4.05, -1, -1}, {7, 1, 9});
  WallCase wall({{wall_plate()}, {post}}, wall_ball(), at_mm(0, 0, 5));
  const Tick tick = wall.go(at_mm(0, 0, 3.9), 300);
  ASSERT_FALSE(tick.points.empty());
  ASSERT_TRUE(tick.contacts && tick.contacts->distance);
  EXPECT_NEAR(tick.contacts->distance->lower, 0.005, 1e-6) << "mesh units";
  EXPECT_NEAR(tick.contacts->distance->upper, 0.005, 1e-6);
}

// The tool can make no way between a plate that rests and one that rises. The script waits.
TEST(WallMotion, ToolPinnedByScript_ScriptWaits) {
  const TriangleMesh above = box({-20, -20, 4.5}, {20, 20, 6});
  const Plan rises = moves_straight({0, 0, -5}, {0, 0, -2}, 0.3);
  WallCase wall({{above}, {wall_plate(), rises}}, wall_ball(), at_mm(0, 0, 0));
  bool was_held = false;
  Tick tick;
  for (int i = 0; i < 600; ++i) {
    tick = wall.tick(at_mm(0, 0, 0));
    was_held |= tick.held;
  }
  EXPECT_TRUE(was_held);
  EXPECT_TRUE(tick.held) << "it is held as long as it is pinned";
  const double height = 1e3 * wall.fixed_pose(1).translation.z();
  EXPECT_NEAR(height, -3.51, 1e-3) << "a ball and two skins below the upper plate";
}

TEST(WallMotion, ScriptFasterThanTrust_NeverMeetsTheTool) {
  for (const double speed : {100.0, 500.0, 5000.0}) {  // mm/s
    const double seconds = 30 / speed;
    const auto height = [](const WallCase& of) { return 1e3 * of.fixed_pose(0).translation.z(); };
    WallCase wall({{wall_plate(), moves_straight({0, 0, -10}, {0, 0, 20}, seconds)}}, wall_ball(),
                  at_mm(0, 0, 0));
    wall.hold(at_mm(0, 0, 0), static_cast<int>(1000 * seconds));
    EXPECT_LT(height(wall), 19) << "it waits for the tool";
    EXPECT_GE(wall.tool().z(), height(wall) + 4);
    wall.hold(at_mm(0, 0, 0), 1200);
    EXPECT_NEAR(height(wall), 20, 1e-9);
    EXPECT_NEAR(wall.tool().z(), 24.005, 1e-6);
  }
}

// A budget that no search comes to the end of holds the tool. With a full one it goes on.
TEST(WallMotion, BudgetEnds_ToolStaysAndGoesOn) {
  WallCase wall(wall_ring(), wall_ball(), at_mm(6, 0, 8)),
      full(wall_ring(), wall_ball(), at_mm(6, 0, 8));
  wall.go_at(at_mm(6, 0, 4), 20);
  full.go_at(at_mm(6, 0, 4), 20);
  const Placement before = wall.pose();
  TickBudget few;
  few.contacts.tests = 5;
  for (int i = 1; i <= 50; ++i) {
    const Tick tick = wall.tick(at_mm(6 - 0.02 * i, 0, 4), few);
    EXPECT_TRUE(tick.held);
    EXPECT_FALSE(tick.contacts->complete);
    EXPECT_LE(tick.contacts->sphere_tests, 200U);
    EXPECT_LE(tick.steps, i == 1) << "a pose that is known costs no tests";
  }
  EXPECT_LE((wall.pose().translation - before.translation).norm(), WallCase::kTrust);
  wall.hold(at_mm(5, 0, 4), 500);
  full.go_at(at_mm(5, 0, 4), 20);
  full.hold(at_mm(5, 0, 4), 500);
  EXPECT_LT((wall.tool() - full.tool()).norm(), 1e-9) << "mm";
  EXPECT_EQ(wall.held(), 50);
}

// Ticks whose budget ended are replayed by their steps.
TEST(WallMotion, StepsOfHeldTicks_ReplaySameBits) {
  struct Record {
    Placement device;
    int steps;
    bool held;
  };
  std::vector<Record> records;
  WallCase first(wall_ring(), wall_ball(), at_mm(6, 0, 8)),
      second(wall_ring(), wall_ball(), at_mm(6, 0, 8));
  int held_part = 0;
  for (int i = 0; i < 600; ++i) {
    const Placement device = at_mm(6 - 0.015 * std::max(0, i - 200), 0.002 * i,
                                   std::max(4.0, 8 - 0.03 * i), turn_about({1, 2, 3}, 0.03 * i));
    TickBudget budget;
    if (i % 3 == 0) budget.contacts.tests = 20 * static_cast<std::uint64_t>(i % 200);
    const Tick tick = first.tick(device, budget);
    records.push_back({device, tick.steps, tick.held});
    held_part += tick.held && tick.steps > 0;
  }
  EXPECT_GT(first.held(), 20);
  EXPECT_GT(held_part, 5) << "some ticks end between two steps";
  for (const Record& record : records) {
    TickBudget budget;
    if (record.held) budget.steps = record.steps;
    const Tick tick = second.tick(record.device, budget);
    EXPECT_EQ(tick.steps, record.steps);
    EXPECT_EQ(tick.held, record.held);
  }
  EXPECT_EQ(first.path(), second.path());
}

TEST(WallMotion, WorkersAndInstructionSets_GiveSameBits) {
  const auto path = [](const WallCaseOptions& options) {
    WallCase wall({{wall_ring()}, {moved(wall_plate(), {0, 0, -4})}}, wall_ball(), at_mm(6, 0, 8),
                  options);
    slide_over_ring(wall);
    return wall.path();
  };
  for (const double friction : {0.0, 0.3}) {
    const std::uint64_t one = path({.friction = friction});
    EXPECT_EQ(one, path({.friction = friction, .workers = 2}));
    EXPECT_EQ(one, path({.friction = friction, .target = "scalar"}));
  }
}

}  // namespace
}  // namespace ist::test
