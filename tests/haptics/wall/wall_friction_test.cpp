// Friction of a tool on a wall, by the cone of eight directions.

#include <gtest/gtest.h>

#include <cmath>

#include "haptics/wall/wall_case.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr double kWallFriction = 0.3;

Placement drawn_along_plate(double degrees, double way) {
  const Vector3d to = turn_about(Vector3d::UnitZ(), degrees) * Vector3d(way, 0, 0);
  return at_mm(to.x(), to.y(), 4);
}

double pull_of_press(const Tick& tick) { return tick.wrench.head<2>().norm() / tick.wrench[2]; }

// Between two directions of the cone the box slips at the cosine of half their angle.
TEST(WallFriction, BoxDrawnAlongPlate_SlipsAtItsPartOfThePress) {
  for (const double degrees : {0.0, 45.0, 180.0, 22.5, 112.5}) {
    const bool between = std::fmod(degrees, 45) > 0;
    const double slips_at = between ? kWallFriction * std::cos(std::acos(-1) / 8) : kWallFriction;
    WallCase wall(wall_plate(), wall_cube(), at_mm(0, 0, 5.5), {.friction = kWallFriction});
    wall.go_at(at_mm(0, 0, 4), 10);
    wall.hold(at_mm(0, 0, 4), 200);
    const Vector3d start = wall.tool();
    double creep = 0, slipped = 0, sliding = 0, lift = 0;
    int slides = 0;
    for (int i = 1; i <= 1000; ++i) {
      const Tick tick = wall.tick(drawn_along_plate(degrees, 0.5e-3 * i));
      const double moved = (wall.tool() - start).head<2>().norm();
      if (slipped == 0 && moved > 1e-4) slipped = pull_of_press(tick);
      if (slipped == 0) creep = std::max(creep, moved);
      if (i > 800) {
        sliding += pull_of_press(tick);
        ++slides;
        lift = std::max(lift, wall.tool().z() - start.z());
      }
    }
    EXPECT_NEAR(slipped, slips_at, 6e-4) << degrees;
    EXPECT_NEAR(sliding / slides, slips_at, 1e-4) << degrees;
    EXPECT_LT(creep, 1e-7) << "mm, before it slips";
    EXPECT_LT(lift, 1e-3) << "mm";
    const Vector3d stopped = wall.tool();
    const Tick tick = wall.hold(drawn_along_plate(degrees, 0.5), 1000);
    EXPECT_LT((wall.tool() - stopped).norm(), 1e-3);
    const Vector3d rest = wall.tool();
    wall.hold(drawn_along_plate(degrees, 0.5), 1000);
    EXPECT_EQ(wall.tool(), rest) << "it stands";
    EXPECT_LE(pull_of_press(tick), kWallFriction + 1e-6);
    expect_balance(tick);
  }
}

// The device goes straight down over a slope. The box sticks to a slope inside the cone. On a
// steeper one it slides until the pull along the slope is its part of the press.
TEST(WallFriction, BoxPressedOnSlope_SticksInsideTheCone) {
  for (const double tangent : {0.25, 0.35}) {
    const double angle = std::atan(tangent), depth = 2, gap = 0.01;
    const Eigen::Matrix3d turn = turn_about(Vector3d::UnitY(), angle * 180 / std::acos(-1));
    const Vector3d start = turn * Vector3d(0, 0, 5 + gap);
    WallCase wall(turned(box({-30, -30, -2}, {30, 30, 0}), turn), wall_cube(),
                  at_mm(start.x(), start.y(), start.z(), turn), {.friction = kWallFriction});
    const Placement device = at_mm(start.x(), start.y(), start.z() - depth, turn);
    wall.go(device, 400);
    wall.hold(device, 1000);
    const double slid = (turn.transpose() * (wall.tool() - start)).x();
    const double press = depth * std::cos(angle) - (gap - 0.005);
    const double slides = depth * std::sin(angle) - kWallFriction * press;
    if (tangent < kWallFriction) {
      EXPECT_NEAR(slid, (gap - 0.005) * tangent, 2e-4) << "the way before it touches, mm";
    } else {
      EXPECT_NEAR(slid, slides, 1e-5) << "mm";
    }
  }
}

// A plate that moves takes the box with it as far as its part of the press.
TEST(WallFriction, PlateThatMoves_DragsTheBox) {
  const Plan plan({{0, {}}, {0.3, {}}, {1.3, at_mm(2, 0, 0)}});
  WallCase wall({{wall_plate(), plan}}, wall_cube(), at_mm(0, 0, 5.5), {.friction = kWallFriction});
  wall.go(at_mm(0, 0, 4), 250);
  const Tick sticks = wall.hold(at_mm(0, 0, 4), 150);  // the plate has moved by 0.2 mm
  EXPECT_NEAR(wall.tool().x(), 0.2, 1e-3);
  EXPECT_NEAR(sticks.wrench[0], 0.2, 1e-3);
  const Tick slips = wall.hold(at_mm(0, 0, 4), 1000);
  EXPECT_NEAR(pull_of_press(slips), kWallFriction, 1e-4);
  EXPECT_GT(slips.wrench[0], 0);
  EXPECT_EQ(wall.held(), 0);
}

}  // namespace
}  // namespace ist::test
