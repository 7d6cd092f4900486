#include "ist/haptics/effects/gravity_effect.h"

#include <gtest/gtest.h>

#include "haptics/effects/effect_case.h"
#include "support/effort.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

TEST(GravityEffect, NeedsNothing) {
  const GravityEffect gravity({.mass = 1, .centre = Vector3d::Zero(), .acceleration = {0, 0, -9}});
  EXPECT_EQ(gravity.name(), "gravity");
  EXPECT_EQ(asked(gravity.needs()), (std::array{false, false, false, false, false}));
}

TEST(GravityEffect, IsTheWeightAtTheCentreOfMassHoweverTheToolIsTurned) {
  const GravityEffect gravity(
      {.mass = 0.2, .centre = {0.03, 0, 0.01}, .acceleration = {0, 0, -10}});
  EffectCase c;
  EXPECT_LE((respond(gravity, c).wrench - six({0, 0, -2}, {0, 0.06, 0})).norm(), 1e-16);
  // A quarter turn about z before the tick, another one in it: twice the tangent of 45° is 2.
  c.tool = Placement{}.moved(six({1, 2, 3}, {0, 0, 2}));
  EXPECT_LE((respond(gravity, c).wrench - six({0, 0, -2}, {-0.06, 0, 0})).norm(), 1e-16);
  EXPECT_LE((respond(gravity, c, six({5, 5, 5}, {0, 0, 2})).wrench - six({0, 0, -2}, {0, -0.06, 0}))
                .norm(),
            1e-16);
  EXPECT_EQ(respond(gravity, c).stiffness, Matrix6::Zero());
}

TEST(GravityEffect, GivesBackWhatLiftingTook) {
  // The torque is what the height of the centre of mass loses in a turn: m a · dc/dω.
  const Vector3d acceleration(1, -2, -9), centre(0.02, -0.01, 0.03);
  const GravityEffect gravity({.mass = 0.5, .centre = centre, .acceleration = acceleration});
  Random random(41);
  for (int i = 0; i < samples(100); ++i) {
    EffectCase c = random_case(random, 0);
    const Vector6 wrench = respond(gravity, c).wrench;
    for (int k = 0; k < 6; ++k) {
      const auto work = [&](double step) {
        const Placement tool = c.tool.moved(step * Vector6::Unit(k));
        return 0.5 * acceleration.dot(tool.translation + tool.rotation * centre);
      };
      ASSERT_NEAR(wrench[k], (work(1e-4) - work(-1e-4)) / 2e-4, 1e-8);
    }
  }
}

}  // namespace
}  // namespace ist::test
