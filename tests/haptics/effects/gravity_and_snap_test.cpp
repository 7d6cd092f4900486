#include <gtest/gtest.h>

#include "haptics/effects/effect_case.h"
#include "loop/haptics/effects/gravity_effect.h"
#include "loop/haptics/effects/snap_effect.h"
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
  // The torque is the derivative of the potential energy by the turn: m a · dc/dω.
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

constexpr double kSnapStiffness = 400, kSnapAngular = 0.5, kSnapRadius = 2e-3, kSnapAngle = 0.1;

SnapSettings settings() {
  return {.pose = Placement{}.moved(six({0.3, -0.1, 0.2}, {0.4, -0.8, 0.3})),
          .stiffness = kSnapStiffness,
          .angular_stiffness = kSnapAngular,
          .radius = kSnapRadius,
          .angle = kSnapAngle};
}

double cube(double x) { return x * x * x; }

// The energy as the header writes it.
double energy(const Placement& tool) {
  const Vector6 way = motion_between(tool, settings().pose);
  const double s = way.head<3>().squaredNorm() / (kSnapRadius * kSnapRadius);
  const double t = way.tail<3>().squaredNorm() / (kSnapAngle * kSnapAngle);
  const auto p = [](double x) { return x < 1 ? cube(1 - x) : 0; };
  const auto q = [](double x) { return x < 1 ? cube(1 - x * x) : 0; };
  return -kSnapStiffness * kSnapRadius * kSnapRadius / 6 * p(s) * q(t) -
         kSnapAngular * kSnapAngle * kSnapAngle / 6 * q(s) * p(t);
}

EffectCase at(const Vector6& from_pose) {
  EffectCase c;
  c.tool = settings().pose.moved(from_pose);
  return c;
}

TEST(SnapEffect, NeedsNothing) {
  const SnapEffect snap(settings());
  EXPECT_EQ(snap.name(), "snap");
  EXPECT_EQ(asked(snap.needs()), (std::array{false, false, false, false, false}));
}

TEST(SnapEffect, DrawsToThePoseByTheFormula) {
  const SnapEffect snap(settings());
  EXPECT_LE(respond(snap, at(Vector6::Zero())).wrench.norm(), 1e-12);
  // Half the radius away: s = 1/4, so k (3/4)² x, and nothing turns.
  const Vector6 away = respond(snap, at(six({0.5 * kSnapRadius, 0, 0}, {0, 0, 0}))).wrench;
  const double turned_well = 2 * kSnapAngular * (kSnapAngle * kSnapAngle) /
                             (kSnapRadius * kSnapRadius) * 0.25 * (0.9375 * 0.9375);
  EXPECT_NEAR(away[0], -(kSnapStiffness * 0.5625 + turned_well) * 0.5 * kSnapRadius, 1e-12);
  EXPECT_LE(away.tail<5>().norm(), 1e-12);
  // Half the angle, and no way to go.
  const Vector6 turned = respond(snap, at(six({0, 0, 0}, {0, 0.5 * kSnapAngle, 0}))).wrench;
  const double shifted_well = 2 * kSnapStiffness * (kSnapRadius * kSnapRadius) /
                              (kSnapAngle * kSnapAngle) * 0.25 * (0.9375 * 0.9375);
  EXPECT_NEAR(turned[4],
              -(kSnapAngular * 0.5625 + shifted_well) * (1 + 0.0625 * kSnapAngle * kSnapAngle) *
                  0.5 * kSnapAngle,
              1e-12);
  EXPECT_LE(turned.head<4>().norm() + std::abs(turned[5]), 1e-12);
  // The motion within the tick counts like earlier motion.
  EXPECT_LE(
      (respond(snap, at(Vector6::Zero()), six({0.5 * kSnapRadius, 0, 0}, {0, 0, 0})).wrench - away)
          .norm(),
      1e-12);
}

TEST(SnapEffect, IsSilentBeyondTheRadiusOrTheAngleAndSmoothThere) {
  const SnapEffect snap(settings());
  Random random(51);
  for (int i = 0; i < samples(200); ++i) {
    const Vector3d way = random.direction(), axis = random.direction();
    const double some = random.uniform(0, 0.9);
    for (const bool by_turn : {false, true}) {
      const auto reach = [&](double part) {
        return by_turn ? six(some * kSnapRadius * way, part * kSnapAngle * axis)
                       : six(part * kSnapRadius * way, some * kSnapAngle * axis);
      };
      const Response beyond = respond(snap, at(reach(1 + 1e-9)));
      ASSERT_EQ(beyond.wrench, Vector6::Zero());
      ASSERT_EQ(beyond.stiffness, Matrix6::Zero());
      // Within e of the edge it is of the order of e²: its slope is 0 there too.
      const double largest = kSnapStiffness * kSnapRadius + kSnapAngular * kSnapAngle;
      ASSERT_LE(respond(snap, at(reach(1 - 1e-4))).wrench.norm(), 1e4 * 1e-8 * largest);
      ASSERT_GT(respond(snap, at(reach(1 - 1e-4))).wrench.norm(), 0);
    }
  }
}

TEST(SnapEffect, IsWhatItsEnergyLosesOnTheWay) {
  const SnapEffect snap(settings());
  Random random(52);
  for (int i = 0; i < samples(500); ++i) {
    const EffectCase c =
        at(six(random.point(-1, 1) * kSnapRadius, random.point(-1, 1) * kSnapAngle));
    const Vector6 wrench = respond(snap, c).wrench;
    for (int k = 0; k < 6; ++k) {
      const double step = k < 3 ? 1e-4 * kSnapRadius : 1e-4 * kSnapAngle;
      const double slope = (energy(c.tool.moved(step * Vector6::Unit(k))) -
                            energy(c.tool.moved(-step * Vector6::Unit(k)))) /
                           (2 * step);
      const double largest = k < 3 ? kSnapStiffness * kSnapRadius : kSnapAngular * kSnapAngle;
      ASSERT_NEAR(wrench[k], -slope, 1e-5 * largest);
    }
  }
}

TEST(SnapEffect, GainsNothingOnAClosedPathOfMovesAndTurns) {
  // Out, turn, back, turn back: what one window on both would give energy for.
  const SnapEffect snap(settings());
  Vector6 from_pose = Vector6::Zero();
  double work = 0, moved = 0;
  const auto go = [&](const Vector6& way) {
    constexpr int kSteps = 400;
    const Vector6 step = way / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      // A step's own turn: at an angle, twice a tangent grows faster than the angle.
      const Vector6 motion = motion_between(at(from_pose).tool, at(from_pose + step).tool);
      const double done = respond(snap, at(from_pose + 0.5 * step)).wrench.dot(motion);
      work += done;
      moved += std::abs(done);
      from_pose += step;
    }
  };
  const Vector6 out = six({0.7 * kSnapRadius, 0, 0}, {0, 0, 0});
  const Vector6 turn = six({0, 0, 0}, {0, 0.7 * kSnapAngle, 0});
  for (const Vector6& way : {out, turn, Vector6(-out), Vector6(-turn)}) go(way);
  EXPECT_GT(moved, 1e-4);
  // The midpoint rule with 400 steps leaves this error.
  EXPECT_LE(std::abs(work), 1e-5 * moved);
}

TEST(SnapEffect, HasTheStiffnessThatDifferencesShowAtThePoseAndIsPositiveEverywhere) {
  const SnapEffect snap(settings());
  const Response here = respond(snap, at(Vector6::Zero()));
  EXPECT_LE(difference(here.stiffness,
                       measured_stiffness(snap, at(Vector6::Zero()), Vector6::Zero(), 1e-6)),
            1e-5);
  EXPECT_NEAR(here.stiffness(0, 0), kSnapStiffness, 1e-9);
  EXPECT_NEAR(here.stiffness(5, 5), kSnapAngular, 1e-12);
  Random random(53);
  for (int i = 0; i < samples(500); ++i) {
    const EffectCase c =
        at(six(random.point(-1, 1) * kSnapRadius, random.point(-1, 1) * kSnapAngle));
    const Response response = respond(snap, c);
    ASSERT_TRUE(is_symmetric_and_semidefinite(response.stiffness));
    // The secant's: it would bring the tool to the pose in one step.
    const Vector6 way = motion_between(c.tool, settings().pose);
    ASSERT_LE((response.stiffness * way - response.wrench).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace ist::test
