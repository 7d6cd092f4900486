#include <gtest/gtest.h>

#include "haptics/effects/effect_case.h"
#include "loop/haptics/effects/damping_effect.h"
#include "loop/haptics/effects/proximity_effect.h"
#include "loop/haptics/effects/springs_effect.h"
#include "support/effort.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr double kStiffness = 800;
const SpringsEffect kSprings({.stiffness = kStiffness});

TEST(SpringsEffect, NeedsNormalsAndDepth) {
  EXPECT_EQ(kSprings.name(), "springs");
  EXPECT_EQ(asked(kSprings.needs()), (std::array{true, true, false, false, false}));
  EXPECT_TRUE(kSprings.needs().contacts());
}

TEST(SpringsEffect, IsASpringAlongTheNormalWithItsTorque) {
  EffectCase c;
  c.add_contact({{0.01, 0.02, 0}, {0, 0, 1}, 1e-4, 0.5});
  const double at_rest = kStiffness * 0.5 * 1e-4;
  Vector6 expected = six({0, 0, at_rest}, {0.02 * at_rest, -0.01 * at_rest, 0});
  EXPECT_LE((respond(kSprings, c).wrench - expected).norm(), 1e-16);

  // Pressed by 30 µm more, by going there or by turning about x with an arm of 20 mm.
  const double pressed = kStiffness * 0.5 * (1e-4 + SpringsEffect::kLead * 3e-5);
  expected = six({0, 0, pressed}, {0.02 * pressed, -0.01 * pressed, 0});
  EXPECT_LE((respond(kSprings, c, six({0, 0, -3e-5}, {0, 0, 0})).wrench - expected).norm(), 1e-15);
  EXPECT_LE((respond(kSprings, c, six({0, 0, 0}, {-1.5e-3, 0, 0})).wrench - expected).norm(),
            1e-15);
  EXPECT_NEAR(kSprings.force(c.contacts.points()[0], six({0, 0, -3e-5}, {0, 0, 0})),
              kStiffness * 0.5 * 1.3e-4, 1e-15);
  // Along the plane nothing changes.
  const Vector6 along = six({1e-3, -2e-3, 0}, {0, 0, 0.1});
  EXPECT_LE((respond(kSprings, c, along).wrench - respond(kSprings, c).wrench).norm(), 1e-16);
}

TEST(SpringsEffect, NeverPulls) {
  EffectCase c;
  c.add_contact({{0.01, 0, 0}, {0, 1, 0}, 1e-4, 1});
  const Response off = respond(kSprings, c, six({0, 2e-4, 0}, {0, 0, 0}));
  EXPECT_LE(off.wrench.norm(), 1e-16);
  EXPECT_EQ(off.stiffness, Matrix6::Zero());
  EXPECT_EQ(kSprings.force(c.contacts.points()[0], six({0, 2e-4, 0}, {0, 0, 0})), 0);
}

TEST(SpringsEffect, IsTheWholeSpringAtThePoseWhateverThePointsSay) {
  Random random(21);
  EffectCase c = random_case(random, 5);
  c.contacts.spring += six({0.1, 0.2, 0.3}, {0.001, 0.002, 0.003});
  EXPECT_LE((respond(kSprings, c).wrench - kStiffness * c.contacts.spring).norm(), 1e-13);
}

TEST(SpringsEffect, AddsToWhatIsThere) {
  Random random(22);
  const EffectCase c = random_case(random, 3);
  Response twice;
  kSprings.respond(c.input(), Vector6::Zero(), twice);
  kSprings.respond(c.input(), Vector6::Zero(), twice);
  const Response once = respond(kSprings, c);
  EXPECT_LE((twice.wrench - 2 * once.wrench).norm(), 1e-14);
  EXPECT_LE(difference(twice.stiffness, 2 * once.stiffness), 1e-15);
}

TEST(SpringsEffect, HasTheStiffnessThatDifferencesShow) {
  Random random(23);
  for (int i = 0; i < samples(300); ++i) {
    const EffectCase c = random_case(random, 1 + i % 6);
    const Vector6 motion = six(random.point(-1e-6, 1e-6), random.point(-3e-5, 3e-5));
    const Response response = respond(kSprings, c, motion);
    // The law is linear between its kinks: only rounding is left, over a step of 1e-7.
    ASSERT_LE(difference(response.stiffness, measured_stiffness(kSprings, c, motion, 1e-7)), 1e-6);
    ASSERT_TRUE(is_symmetric_and_semidefinite(response.stiffness));
  }
}

TEST(Response, TurnsAForceAndItsChangeIntoThoseOfTheTool) {
  Random random(24);
  for (int i = 0; i < samples(300); ++i) {
    const Vector3d arm = random.point(-1, 1), force = random.point(-1, 1);
    const Eigen::Matrix3d root = Eigen::Matrix3d::NullaryExpr(
        [&](Eigen::Index, Eigen::Index) { return random.uniform(-1, 1); });
    const Eigen::Matrix3d change = root * root.transpose();
    Response response;
    response.add(arm, force, change);
    EXPECT_EQ(response.wrench, six(force, arm.cross(force)));
    // The stiffness is the map from a motion to the way of the place, to its force, to a wrench.
    const ToolContact point{arm, Vector3d::UnitX(), 0, 1};
    for (int k = 0; k < 6; ++k) {
      const Vector3d less = change * point.moved(Vector6::Unit(k));
      ASSERT_LE((response.stiffness.col(k) - six(less, arm.cross(less))).norm(), 1e-14);
    }
    ASSERT_TRUE(is_symmetric_and_semidefinite(response.stiffness));
  }
}

constexpr double kDamping = 2;
const DampingEffect kDamper({kDamping});
const ProximityEffect kBrake({.distance = 1e-3, .damping = kDamping / ProximityEffect::kFullPairs});

TEST(DampingEffect, NeedsNormalsAndVelocity) {
  EXPECT_EQ(kDamper.name(), "damping");
  EXPECT_EQ(asked(kDamper.needs()), (std::array{true, false, true, false, false}));
}

TEST(ProximityEffect, NeedsProximityVoxelsAndVelocityAndNoContacts) {
  EXPECT_EQ(kBrake.name(), "proximity");
  EXPECT_EQ(asked(kBrake.needs()), (std::array{false, false, true, true, false}));
  EXPECT_FALSE(kBrake.needs().contacts());
}

TEST(DampingEffect, HoldsBackWhatApproachesAndNothingElse) {
  EffectCase c;
  c.dt = 1e-4;
  c.add_contact({{0.01, 0.02, 0}, {0, 0, 1}, 1e-4, 0.5});
  // 10 µm in a tick of 0.1 ms is 0.1 m/s. Motion along the surface does not count.
  const double force = kDamping * 0.5 * 0.1;
  const Vector6 expected = six({0, 0, force}, {0.02 * force, -0.01 * force, 0});
  EXPECT_LE((respond(kDamper, c, six({5e-5, 0, -1e-5}, {0, 0, 0.3})).wrench -
             six({0, 0, 1}, {0.02, -0.01, 0}) * force)
                .norm(),
            1e-15);
  // The same speed by a turn.
  EXPECT_LE((respond(kDamper, c, six({0, 0, 0}, {-5e-4, 0, 0})).wrench - expected).norm(), 1e-15);
  for (const Vector6& motion : {six({0, 0, 1e-5}, {0, 0, 0}), six({1e-5, 1e-5, 0}, {0, 0, 0}),
                                six({0, 0, 0}, {0, 0, 0.1}), six({0, 0, 0}, {0, 0, 0})}) {
    const Response response = respond(kDamper, c, motion);
    EXPECT_EQ(response.wrench, Vector6::Zero());
    EXPECT_EQ(response.stiffness, Matrix6::Zero());
  }
}

TEST(DampingEffect, IsTheSameAtAnyOverlapAndFadesWithTheFraction) {
  const Vector6 motion = six({0, 0, -1e-5}, {0, 0, 0});
  EffectCase whole, thin, faint;
  whole.add_contact({{0, 0, 0}, {0, 0, 1}, 1e-4, 1});
  thin.add_contact({{0, 0, 0}, {0, 0, 1}, 0, 1});
  faint.add_contact({{0, 0, 0}, {0, 0, 1}, 1e-4, 1e-6});
  EXPECT_EQ(respond(kDamper, whole, motion).wrench, respond(kDamper, thin, motion).wrench);
  EXPECT_NEAR(respond(kDamper, faint, motion).wrench[2],
              1e-6 * respond(kDamper, whole, motion).wrench[2], 1e-20);
}

TEST(ProximityEffect, IsTheLawOfDampingAtThePlacesNearBy) {
  Random random(31);
  int braking = 0;
  for (int i = 0; i < samples(100); ++i) {
    EffectCase near = random_case(random, 4), touching = near;
    touching.contacts.clear();
    for (const ToolContact& point : near.proximity.points()) touching.contacts.add(point);
    near.contacts.clear();
    touching.proximity.clear();
    const Vector6 motion = six(random.point(-1e-5, 1e-5), random.point(-1e-3, 1e-3));
    const Response braked = respond(kBrake, near, motion);
    braking += braked.wrench.norm() > 0;
    ASSERT_EQ(braked.wrench, respond(kDamper, touching, motion).wrench);
    ASSERT_EQ(braked.stiffness, respond(kDamper, touching, motion).stiffness);
    ASSERT_EQ(respond(kDamper, near, motion).wrench, Vector6::Zero());
    ASSERT_EQ(respond(kBrake, touching, motion).wrench, Vector6::Zero());
  }
  EXPECT_GT(braking, samples(60));
}

TEST(DampingEffect, HasTheStiffnessThatDifferencesShow) {
  Random random(32);
  for (int i = 0; i < samples(300); ++i) {
    const EffectCase c = random_case(random, 1 + i % 6);
    const Vector6 motion = six(random.point(-1e-5, 1e-5), random.point(-1e-3, 1e-3));
    // A case without a point that is about to turn from approach to retreat.
    bool smooth = true, approaches = false;
    for (const ToolContact& point : c.contacts.points()) {
      const double approach = -point.normal.dot(point.moved(motion));
      smooth = smooth && std::abs(approach) > 3e-8;
      approaches = approaches || approach > 0;
    }
    if (!smooth || !approaches) continue;
    const Response response = respond(kDamper, c, motion);
    ASSERT_LE(difference(response.stiffness, measured_stiffness(kDamper, c, motion, 1e-8)), 1e-6);
    ASSERT_TRUE(is_symmetric_and_semidefinite(response.stiffness));
  }
}

TEST(DampingEffect, OnlyTakesEnergy) {
  Random random(33);
  for (int i = 0; i < samples(1000); ++i) {
    const EffectCase c = random_case(random, 6);
    const Vector6 motion = six(random.point(-1e-5, 1e-5), random.point(-1e-3, 1e-3));
    ASSERT_LE(respond(kDamper, c, motion).wrench.dot(motion), 0);
    ASSERT_LE(respond(kBrake, c, motion).wrench.dot(motion), 0);
  }
}

TEST(DampingEffect, IsContinuousWhereApproachTurnsToDeparture) {
  Random random(34);
  for (int i = 0; i < samples(200); ++i) {
    const EffectCase c = random_case(random, 6);
    Vector6 motion = six(random.point(-1e-5, 1e-5), random.point(-1e-3, 1e-3));
    const ToolContact& point = c.contacts.points()[0];
    motion.head<3>() -= point.normal.dot(point.moved(motion)) * point.normal;  // only along
    const Vector6 small = six(1e-13 * point.normal, Vector3d::Zero());
    // 2 N s/m, 1e-3 s, six places: at most 12 kN/m times 0.2 pm.
    ASSERT_LE(
        (respond(kDamper, c, motion - small).wrench - respond(kDamper, c, motion + small).wrench)
            .norm(),
        3e-9);
  }
}

}  // namespace
}  // namespace ist::test
