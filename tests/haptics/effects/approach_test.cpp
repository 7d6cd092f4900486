#include <gtest/gtest.h>

#include "haptics/effects/effect_case.h"
#include "ist/haptics/effects/damping_effect.h"
#include "ist/haptics/effects/proximity_effect.h"
#include "support/effort.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr double kDamping = 2;
const DampingEffect kDamper({kDamping});
const ProximityEffect kBrake({.distance = 1e-3, .damping = kDamping});

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
  // 10 µm a tick of 0.1 ms: 0.1 m/s. What goes along with it counts for nothing.
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

TEST(DampingEffect, IsTheSameAtAnyOverlapAndFadesWithTheShare) {
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
    // Where no place is about to turn from approach to retreat.
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
