#include <gtest/gtest.h>

#include <algorithm>

#include "haptics/effects/pressed_tool.h"
#include "support/effort.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr FrictionSettings kHold{
    .static_coefficient = 0.5, .dynamic_coefficient = 0.3, .stiffness = 500};

TEST(FrictionEffect, TakesWorkOnEveryPathFromItsFirstTickOn) {
  Random random(71);
  for (int path = 0; path < samples(20); ++path) {
    PressedTool tool(kHold, {Vector3d::Zero()}, 1);
    double work = 0;
    int slid = 0;
    for (int i = 0; i < 2000; ++i) {
      tool.press(random.uniform(0.1, 2));
      const Vector6 motion =
          six({random.uniform(-1, 1) * 4e-4, random.uniform(-1, 1) * 4e-4, 0}, {0, 0, 0});
      work -= tool.move(motion).dot(motion);
      slid += tool.friction().slides();
      ASSERT_GE(work, -1e-15) << i;
    }
    EXPECT_GT(slid, 20);
    EXPECT_LT(slid, 1980);
    EXPECT_GT(work, 1e-4);
  }
}

TEST(FrictionEffect, LosesWhatItSaysOnAClosedPath) {
  // There and back, sliding: µ_d N times the way, but for what the spring holds at the turns.
  constexpr double kWeight = 2, kWay = 0.05;
  constexpr int kSteps = 5000;
  FrictionSettings even = kHold;
  even.static_coefficient = even.dynamic_coefficient;
  PressedTool tool(even, {Vector3d::Zero()}, kWeight);
  double work = 0;
  for (int lap = 0; lap < 4; ++lap) {
    const double step = (lap % 2 == 0 ? kWay : -kWay) / kSteps;
    for (int i = 0; i < kSteps; ++i) work -= tool.slide(step)[0] * step;
  }
  const double force = 0.3 * kWeight, stretch = force / even.stiffness;
  // Each change of direction lets the spring go and draws it anew, over twice the stretch, in which
  // the force is 0 on the mean; the first draws it once.
  const double expected = 4 * kWay * force - 3 * 2 * stretch * force - 0.5 * stretch * force;
  EXPECT_NEAR(work, expected, 1e-3 * expected);
}

TEST(FrictionEffect, TakesWorkThoughTheToolTurns) {
  Random random(72);
  for (int path = 0; path < samples(10); ++path) {
    PressedTool tool(kHold, {{0.01, 0, 0}, {-0.01, 0.008, 0}, {0, -0.012, 0}}, 1);
    double work = 0, least = 0;
    Vector3d heading = Vector3d::Zero();
    for (int i = 0; i < 2000; ++i) {
      // Wandering, slowly enough that it sticks and slides by turns.
      heading = 0.95 * heading + 0.3 * random.point(-1, 1);
      const Vector6 motion =
          six({4e-5 * heading[0], 4e-5 * heading[1], 0}, {0, 0, 3e-3 * heading[2]});
      work -= tool.move(motion).dot(motion);
      least = std::min(least, work);
    }
    EXPECT_GT(work, 1e-3);
    EXPECT_GE(least, -1e-6 * work);
  }
}

TEST(FrictionEffect, ComesToRestAfterEverySlide) {
  Random random(73);
  for (int path = 0; path < samples(20); ++path) {
    PressedTool tool(kHold, {{0.01, 0, 0}, {-0.01, 0.008, 0}, {0, -0.012, 0}}, 1);
    const Vector6 motion = six({random.uniform(-1, 1) * 1e-3, random.uniform(-1, 1) * 1e-3, 0},
                               {0, 0, random.uniform(-1, 1) * 0.05});
    for (int i = 0; i < 20; ++i) tool.move(motion);
    ASSERT_TRUE(tool.friction().slides());
    for (int i = 0; i < 5; ++i) tool.slide(0);
    ASSERT_FALSE(tool.friction().slides());
    const Placement anchor = *tool.friction().anchor();
    const double held = tool.wrench().norm();
    for (int i = 0; i < 1000; ++i) {
      tool.slide(0);
      ASSERT_EQ(tool.friction().anchor()->rotation, anchor.rotation);
      ASSERT_EQ(tool.friction().anchor()->translation, anchor.translation);
    }
    EXPECT_GT(held, 0);
    EXPECT_NEAR(tool.wrench().norm(), held, 1e-9 * held);
  }
}

}  // namespace
}  // namespace ist::test
