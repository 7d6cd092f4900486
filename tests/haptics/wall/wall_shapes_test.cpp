// A tool that a wall keeps free, in closed forms.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "haptics/wall/wall_case.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

TEST(WallShapes, BallOnPlate_ForceIsStiffnessTimesStretch) {
  WallCase wall(wall_plate(), icosphere(3, 5), at_mm(0, 0, 6));
  wall.go_at(at_mm(0, 0, 2), 10);
  const Tick tick = wall.hold(at_mm(0, 0, 2), 500);
  EXPECT_NEAR(tick.wrench[2], 3.005, 1e-6) << "the ball has a vertex on each axis";
  EXPECT_NEAR(wall.gap(), 0.005, 1e-6);
  ASSERT_FALSE(tick.points.empty());
  EXPECT_NEAR(tick.points[0].gap, WallCase::kSkin, 1e-9);
  EXPECT_GT(tick.points[0].normal.z(), 1 - 1e-9);
  expect_balance(tick);
  EXPECT_EQ(wall.held(), 0);
}

// The edge of a bar along x carries the edge of a bar along y.
TEST(WallShapes, EdgeAcrossEdge_TouchesAtTheirCrossing) {
  const double h = std::numbers::sqrt2 * 5;
  const TriangleMesh bar = prism({{0, h}, {-h, 0}, {0, -h}, {h, 0}}, 20);
  WallCase wall(bar, turned(bar, turn_about(Vector3d::UnitZ(), 90)), at_mm(1, 2, 2 * h + 0.5));
  wall.go_at(at_mm(1, 2, 2 * h - 1), 10);
  const Tick tick = wall.hold(at_mm(1, 2, 2 * h - 1), 500);
  ASSERT_EQ(tick.points.size(), 1U);
  const ContactPoint& at = tick.points[0];
  EXPECT_NEAR(at.position.y(), 0, 1e-12);
  EXPECT_NEAR(at.position.z(), 1e-3 * h, 1e-12);
  EXPECT_NEAR(at.position.x(), 1e-3, 1e-5);
  // The crossing is 2 mm from the tool's origin. The bar turns until the springs bear the torque.
  EXPECT_NEAR(std::abs(tick.wrench[3]), tick.wrench[2] * 2e-3, 1e-4);
  EXPECT_NEAR(wall.gap(), 0.005, 1e-6);
  expect_balance(tick);
}

// The ball rests on planes of a cone of 45 degrees. Its surface lies between two spheres.
TEST(WallShapes, BallInCone_RestsAtHeightOfSpheres) {
  const TriangleMesh ball = icosphere(3, 2);
  double inner = 2;
  for (const Triangle& t : ball.triangles) {
    const Vector3d a = ball.vertices[t[0]], b = ball.vertices[t[1]], c = ball.vertices[t[2]];
    inner = std::min(inner, (b - a).cross(c - a).normalized().dot(a));
  }
  const TriangleMesh cone = revolved({{0, 0}, {0, -2}, {4, -2}, {4, 4}}, 48);
  const double slope = std::cos(std::numbers::pi / 48);
  const double height = std::sqrt(1 + slope * slope) / slope;
  for (const Vector3d& start : {Vector3d(0, 0, 4), Vector3d(0.5, 0.3, 4), Vector3d(-0.4, 0.1, 4)}) {
    WallCase wall(cone, ball, at_mm(start.x(), start.y(), start.z()));
    wall.go_at(at_mm(0, 0, 1.5), 10);
    const Tick tick = wall.hold(at_mm(0, 0, 1.5), 1000);
    EXPECT_GT(wall.tool().z(), (inner + 0.005) * height - 1e-6);
    EXPECT_LT(wall.tool().z(), (2 + 0.005) * height + 1e-6);
    EXPECT_LT(wall.tool().head<2>().norm(), 0.01);
    EXPECT_GE(tick.points.size(), 3U);
    expect_balance(tick);
  }
}

// Three balls in three grooves of 45 degrees, the kinematic coupling of Lord Kelvin. Each of six
// contacts bears 1 / (6 cos 45°) of the press.
TEST(WallShapes, ThreeBallsInThreeGrooves_ShareThePress) {
  const TriangleMesh groove = prism({{0, 0}, {-4, 4}, {-4, -2}, {4, -2}, {4, 4}}, 6);
  TriangleMesh fixed, held;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Matrix3d turn = turn_about(Vector3d::UnitZ(), 120 * i);
    const TriangleMesh ball = turned(icosphere(3, 2), turn_about({1, 2, 3}, 20 + 50 * i));
    fixed = joined(fixed, turned(moved(groove, {20, 0, 0}), turn));
    held = joined(held, moved(ball, turn * Vector3d(20, 0, 0)));
  }
  WallCase wall(fixed, held, at_mm(0.3, -0.2, 4, turn_about({1, 0, 1}, 1)));
  wall.go_at(at_mm(0, 0, 0.8), 10);
  const Tick tick = wall.hold(at_mm(0, 0, 0.8), 1000);
  ASSERT_EQ(tick.points.size(), 6U);
  for (const ContactPoint& at : tick.points) {
    EXPECT_NEAR(at.force.norm() / tick.wrench[2], std::numbers::sqrt2 / 6, 0.006);
  }
  EXPECT_NEAR(wall.tool().z(), (2 + 0.005) * std::numbers::sqrt2, 0.02);
  expect_balance(tick);
}

// A torque of the device moves the load to (3, 2) mm.
TEST(WallShapes, BoxPressedOffCentre_CentreOfPressureIsLoad) {
  for (const int cells : {1, 7}) {
    WallCase wall(wall_plate(), fine_box({-5, -5, -5}, {5, 5, 5}, cells), at_mm(0, 0, 5.5));
    wall.go_at(at_mm(0, 0, 4), 10);
    const double force = 1.005, deg = 180 / std::numbers::pi;
    const Vector3d torque = 1e-3 * force * Vector3d(-2, 3, 0);
    const Placement device = at_mm(0, 0, 4, turn_about(torque, torque.norm() * deg));
    wall.go(device, 100);
    const Tick tick = wall.hold(device, 500);
    EXPECT_NEAR(tick.wrench[2], force, 1e-6);
    EXPECT_LT((wall.pose().rotation - Eigen::Matrix3d::Identity()).norm(), 1e-7);
    EXPECT_NEAR(wall.tool().z(), 5.005, 1e-6);
    Vector3d sum = Vector3d::Zero();
    for (const ContactPoint& at : tick.points) sum += at.force.z() * at.position;
    EXPECT_NEAR(1e3 * sum.x() / force, 3, 1e-3);
    EXPECT_NEAR(1e3 * sum.y() / force, 2, 1e-3);
    expect_balance(tick);
  }
}

// Without friction nothing may pull along a plate, however its triangles lie.
TEST(WallShapes, FineBoxDrawnAlongFinePlate_NoDragFromSeams) {
  for (const double degrees : {0.0, 17.0}) {
    const Eigen::Matrix3d turn = turn_about(Vector3d::UnitZ(), degrees);
    WallCase wall(fine_box({-10, -10, -2}, {10, 10, 0}, 21), fine_box({-4, -4, -4}, {4, 4, 4}, 7),
                  at_mm(0, 0, 4.05, turn));
    wall.go_at(at_mm(0, 0, 3, turn), 10);
    const Vector3d along = 2.5 * Vector3d(std::cos(0.3), std::sin(0.3), 0);
    double most = 0;
    for (int i = 1; i <= 500; ++i) {
      const Tick tick = wall.tick(at_mm(along.x() * i / 500, along.y() * i / 500, 3, turn));
      most = std::max(most, tick.wrench.head<2>().norm());
      EXPECT_NEAR(tick.wrench[2], 1.005, 1e-6);
    }
    EXPECT_LT(most, 1e-6) << degrees;
    EXPECT_NEAR(wall.tool().z(), 4.005, 1e-6);
    EXPECT_EQ(wall.held() + wall.halved(), 0);
  }
}

// The box slides to the upright side of a step. Both sides press it.
TEST(WallShapes, BoxPushedIntoStep_TouchesBothSides) {
  const TriangleMesh step = prism({{0, 0}, {0, 20}, {-10, 20}, {-10, -5}, {20, -5}, {20, 0}}, 15);
  WallCase wall(step, wall_cube(), at_mm(0, 8, 6));
  wall.go_at(at_mm(0, 8, 4), 10);
  wall.go_at(at_mm(0, 3, 4), 10);
  const Tick tick = wall.hold(at_mm(0, 3, 4), 300);
  EXPECT_NEAR(wall.tool().y(), 5.005, 1e-5);
  EXPECT_NEAR(wall.tool().z(), 5.005, 1e-5);
  EXPECT_NEAR(tick.wrench[1], 2.005, 1e-4);
  EXPECT_NEAR(tick.wrench[2], 1.005, 1e-4);
  expect_balance(tick);
}

// The upper edge of a step presses the side of a box that leans against it.
TEST(WallShapes, BoxLeaningOnCornerOfStep_TouchesEdgeAndFloor) {
  const TriangleMesh step = prism({{0, 0}, {0, 4}, {-10, 4}, {-10, -5}, {20, -5}, {20, 0}}, 15);
  const Eigen::Matrix3d turn = turn_about(Vector3d::UnitX(), 10);
  WallCase wall(step, wall_cube(), at_mm(0, 8, 6, turn));
  wall.go_at(at_mm(0, 3, 4, turn), 20);
  const Tick tick = wall.hold(at_mm(0, 3, 4, turn), 500);
  const Eigen::Matrix3d& rotation = wall.pose().rotation;
  const Vector3d edge = rotation.transpose() * (Vector3d(0, 0, 4) - wall.tool());
  EXPECT_NEAR(edge.y(), -5.005, 1e-5);
  EXPECT_NEAR((rotation * Vector3d(0, -5, -5) + wall.tool()).z(), 0.005, 1e-5);
  expect_balance(tick);
  wall.go_at(at_mm(0, 3, 12), 20);
  wall.go_at(at_mm(0, -5, 8), 20);
  wall.hold(at_mm(0, -5, 8), 300);
  EXPECT_NEAR(wall.tool().z(), 9.005, 1e-4) << "it stands on the step";
}

// A foil on a foil, from above and from below.
TEST(WallShapes, FoilsHitFast_KeepTheirSides) {
  const TriangleMesh foil = box({-10, -10, -0.005}, {10, 10, 0.005});
  const TriangleMesh held = box({-4, -4, -0.005}, {4, 4, 0.005});
  for (const double side : {1.0, -1.0}) {
    for (const double degrees : {0.0, 3.0, 60.0, 90.0}) {
      const Eigen::Matrix3d turn = turn_about({1, 2, 0.5}, degrees);
      WallCase wall(foil, held, at_mm(0, 0, side * 6, turn));
      for (const double to : {-6.0, 6.0, -3.0, 6.0}) {
        wall.go_at(at_mm(0.3, 0.1, side * to, turn), 100);
        const Tick tick = wall.hold(at_mm(0.3, 0.1, side * to, turn), 50);
        EXPECT_GT(side * wall.tool().z(), 0.01) << degrees << " degrees to " << to;
        if (to < -5) {
          EXPECT_NEAR(tick.wrench.head<3>().norm(), 5, 1e-9);
        }
      }
    }
  }
}

TEST(WallShapes, NeedleOnBall_SlidesOffOutside) {
  const TriangleMesh ball = icosphere(3, 5);
  const TriangleMesh needle = revolved({{0, -10}, {0.1, 10}, {0, 10}}, 6);
  WallCase wall(ball, needle, at_mm(0.4, 0.3, 16));
  const auto tip = [&] {
    return Vector3d(1e3 * wall.pose().translation + wall.pose().rotation * Vector3d(0, 0, -10));
  };
  wall.go_at(at_mm(0.4, 0.3, 11), 20);
  for (int i = 0; i < 500; ++i) {
    wall.tick(at_mm(0.4, 0.3, 11));
    ASSERT_GT(tip().norm(), 4.9) << "the ball's facets lie deeper by 0.02";
  }
  EXPECT_LT(wall.gap(), 0.006);
}

// A box that is pressed with 5 N slips off an edge. The force falls no faster than the trust
// allows.
TEST(WallShapes, BoxSlipsOffEdge_ForceFallsAtBoundedRate) {
  WallCase wall(wall_plate(), box({-3, -3, -3}, {3, 3, 3}), at_mm(19, 0, 3.5));
  wall.go_at(at_mm(19, 0, -5), 50);
  Tick tick = wall.hold(at_mm(19, 0, -5), 100);
  EXPECT_NEAR(tick.wrench[2], 5, 1e-9);
  Vector6 last = tick.wrench;
  double most = 0;
  for (int i = 1; i <= 600; ++i) {
    tick = wall.tick(at_mm(19 + 0.02 * i, 0, -5));
    most = std::max(most, (tick.wrench - last).head<3>().norm());
    last = tick.wrench;
  }
  EXPECT_LT(tick.wrench.norm(), 1e-9) << "it has reached the device";
  EXPECT_LE(most, 1000 * (0.02e-3 + 3 * WallCase::kTrust) + 1e-9);
  EXPECT_GT(most, 0.04);
}

// In free air the tool is where the device is, at any speed.
TEST(WallShapes, FreeAir_ToolFollowsTheDevice) {
  WallCase wall(wall_plate(), wall_cube(), at_mm(0, 0, 9));
  for (const Vector3d& to : {Vector3d(15, 0, 7), Vector3d(-15, 8, 9), Vector3d(0, 0, 60)}) {
    for (const double speed : {100.0, 1000.0, 3000.0}) {
      const Tick tick = wall.go_at(at_mm(to.x(), to.y(), to.z()), speed);
      EXPECT_LT((tick.tool.translation - tick.device.translation).norm(), 1e-9);
      EXPECT_LT(tick.wrench.norm(), 1e-6);
    }
  }
}

// The device goes through a wall at once, moves about behind it, and returns.
TEST(WallShapes, DeviceThatJumps_LeavesToolOnItsSide) {
  WallCase wall(box({-20, -20, -2}, {20, 20, 0}), icosphere(2, 3), at_mm(0, 0, 5));
  wall.hold(at_mm(0, 0, 5), 3);
  for (int round = 0; round < 3; ++round) {
    const Tick tick = wall.hold(at_mm(2, 1, -95, turn_about({1, 1, 0}, 100)), 200);
    EXPECT_GT(wall.tool().z(), 2.5);
    EXPECT_NEAR(tick.wrench.head<3>().norm(), 5, 1e-9);
    wall.hold(at_mm(0, 0, 5), 100);
    EXPECT_LT((wall.tool() - Vector3d(0, 0, 5)).norm(), 1e-6);
  }
}

TEST(WallShapes, UnknownDevice_IsFaultAndToolStays) {
  WallCase wall(wall_plate(), icosphere(2, 3), at_mm(0, 0, 4));
  wall.go_at(at_mm(0, 0, 2), 20);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Placement before = wall.pose();
  for (const std::optional<Placement>& device :
       {std::optional<Placement>(), std::optional(at_mm(nan, 0, 2)),
        std::optional(at_mm(0, 0, HUGE_VAL)),
        std::optional(Placement{Eigen::Matrix3d::Constant(nan), Vector3d::Zero()})}) {
    const Tick tick = wall.tick(device);
    EXPECT_TRUE(tick.fault);
    EXPECT_TRUE(tick.points.empty());
    EXPECT_EQ(wall.pose().translation, before.translation);
    EXPECT_EQ(wall.pose().rotation, before.rotation);
  }
  const Tick tick = wall.hold(at_mm(0, 0, 2), 3);
  EXPECT_FALSE(tick.fault);
  EXPECT_GT(tick.wrench[2], 0.9);
}

}  // namespace
}  // namespace ist::test
