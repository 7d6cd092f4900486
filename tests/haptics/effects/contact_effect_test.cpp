#include "ist/haptics/effects/contact_effect.h"

#include <gtest/gtest.h>

#include "haptics/effects/effect_case.h"
#include "support/effort.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr double kStiffness = 800;
const ContactEffect kContact({kStiffness, 0.5});

TEST(ContactEffect, NeedsNormalsAndDepth) {
  EXPECT_EQ(kContact.name(), "contact");
  EXPECT_EQ(asked(kContact.needs()), (std::array{true, true, false, false, false}));
  EXPECT_TRUE(kContact.needs().contacts());
}

TEST(ContactEffect, IsASpringAlongTheNormalWithItsTorque) {
  EffectCase c;
  c.add_contact({{0.01, 0.02, 0}, {0, 0, 1}, 1e-4, 0.5});
  const double at_rest = kStiffness * 0.5 * 1e-4;
  Vector6 expected = six({0, 0, at_rest}, {0.02 * at_rest, -0.01 * at_rest, 0});
  EXPECT_LE((respond(kContact, c).wrench - expected).norm(), 1e-16);

  // Pressed by 30 µm more, by going there or by turning about x with an arm of 20 mm.
  const double pressed = kStiffness * 0.5 * (1e-4 + ContactEffect::kLead * 3e-5);
  expected = six({0, 0, pressed}, {0.02 * pressed, -0.01 * pressed, 0});
  EXPECT_LE((respond(kContact, c, six({0, 0, -3e-5}, {0, 0, 0})).wrench - expected).norm(), 1e-15);
  EXPECT_LE((respond(kContact, c, six({0, 0, 0}, {-1.5e-3, 0, 0})).wrench - expected).norm(),
            1e-15);
  EXPECT_NEAR(kContact.force(c.contacts.points()[0], six({0, 0, -3e-5}, {0, 0, 0})),
              kStiffness * 0.5 * 1.3e-4, 1e-15);
  // Along the plane nothing changes.
  const Vector6 along = six({1e-3, -2e-3, 0}, {0, 0, 0.1});
  EXPECT_LE((respond(kContact, c, along).wrench - respond(kContact, c).wrench).norm(), 1e-16);
}

TEST(ContactEffect, NeverPulls) {
  EffectCase c;
  c.add_contact({{0.01, 0, 0}, {0, 1, 0}, 1e-4, 1});
  const Response off = respond(kContact, c, six({0, 2e-4, 0}, {0, 0, 0}));
  EXPECT_LE(off.wrench.norm(), 1e-16);
  EXPECT_EQ(off.stiffness, Matrix6::Zero());
  EXPECT_EQ(kContact.force(c.contacts.points()[0], six({0, 2e-4, 0}, {0, 0, 0})), 0);
}

TEST(ContactEffect, IsTheWholeSpringAtThePoseWhateverThePointsSay) {
  Random random(21);
  EffectCase c = random_case(random, 5);
  c.contacts.spring += six({0.1, 0.2, 0.3}, {0.001, 0.002, 0.003});
  EXPECT_LE((respond(kContact, c).wrench - kStiffness * c.contacts.spring).norm(), 1e-13);
}

TEST(ContactEffect, AddsToWhatIsThere) {
  Random random(22);
  const EffectCase c = random_case(random, 3);
  Response twice;
  kContact.respond(c.input(), Vector6::Zero(), twice);
  kContact.respond(c.input(), Vector6::Zero(), twice);
  const Response once = respond(kContact, c);
  EXPECT_LE((twice.wrench - 2 * once.wrench).norm(), 1e-14);
  EXPECT_LE(difference(twice.stiffness, 2 * once.stiffness), 1e-15);
}

TEST(ContactEffect, HasTheStiffnessThatDifferencesShow) {
  Random random(23);
  for (int i = 0; i < samples(300); ++i) {
    const EffectCase c = random_case(random, 1 + i % 6);
    const Vector6 motion = six(random.point(-1e-6, 1e-6), random.point(-3e-5, 3e-5));
    const Response response = respond(kContact, c, motion);
    // The law is linear between its kinks: only rounding is left, over a step of 1e-7.
    ASSERT_LE(difference(response.stiffness, measured_stiffness(kContact, c, motion, 1e-7)), 1e-6);
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

}  // namespace
}  // namespace ist::test
