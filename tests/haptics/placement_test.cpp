#include "ist/haptics/placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "haptics/effects/effect_case.h"
#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

Matrix3d turn(double angle, const Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

Placement some_placement(Random& random) {
  return {turn(random.uniform(-3, 3), random.direction()), random.point(-1, 1)};
}

double farthest_from_rigid(const Matrix3d& r) {
  return (r.transpose() * r - Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

TEST(Placement, ComesBackFromItsMotionAndGoesWhereTheMotionSays) {
  Random random(11);
  for (int i = 0; i < samples(20'000); ++i) {
    const Placement from = some_placement(random), to = some_placement(random);
    const Vector6 motion = six(random.point(-1, 1), random.point(-2, 2));
    ASSERT_LE((motion_between(from, from.moved(motion)) - motion).cwiseAbs().maxCoeff(), 1e-13);
    const Vector6 way = motion_between(from, to);
    if (way.tail<3>().norm() > 100) continue;  // rounding grows with the square of a tangent
    const Placement there = from.moved(way);
    ASSERT_LE((there.rotation - to.rotation).cwiseAbs().maxCoeff(), 1e-11);
    ASSERT_LE((there.translation - to.translation).norm(), 1e-15);
  }
}

TEST(Placement, TurnsByTheMotionsAngleToWithinATwelfthOfItsCube) {
  Random random(12);
  for (const double angle : {1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0}) {
    const Vector3d axis = random.direction();
    const Placement from = some_placement(random);
    const Placement to = from.moved(six(Vector3d::Zero(), angle * axis));
    const Matrix3d turned = to.rotation * from.rotation.transpose();
    // What is missing: the turn that would complete it, about the same axis.
    const Eigen::AngleAxisd missing(turn(angle, axis) * turned.transpose());
    const double short_by = missing.angle() * missing.axis().dot(axis);
    EXPECT_LE(std::abs(short_by), angle * angle * angle / 12 + 1e-15) << angle;
    EXPECT_GE(short_by, angle * angle * angle / 12 * (1 - angle * angle) - 1e-15) << angle;
    EXPECT_EQ(to.translation, from.translation);
  }
}

TEST(Placement, IsExactWhereNumbersAre) {
  const Placement origin;
  const Placement shifted = origin.moved(six({0.25, -3, 1e-9}, Vector3d::Zero()));
  EXPECT_EQ(shifted.rotation, Matrix3d::Identity());
  EXPECT_EQ(shifted.translation, Vector3d(0.25, -3, 1e-9));
  // Twice the tangent of an eighth of a circle is a quarter turn.
  const Placement quarter = origin.moved(six(Vector3d::Zero(), {0, 0, 2}));
  Matrix3d expected;
  expected << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_EQ(quarter.rotation, expected);
  EXPECT_EQ(motion_between(origin, quarter), six(Vector3d::Zero(), {0, 0, 2}));
  EXPECT_EQ(motion_between(quarter, quarter), Vector6::Zero());
  EXPECT_EQ(quarter.moved(Vector6::Zero()).rotation, expected);
  EXPECT_EQ(quarter.isometry().matrix().topLeftCorner(3, 3), expected);
}

TEST(Placement, StaysRigidThroughManyMoves) {
  Random random(13);
  Placement placement = some_placement(random);
  double worst = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    placement = placement.moved(six({1e-6, 0, 0}, {1e-3, -2e-3, 7e-4}));
    if (i % 1000 == 0) worst = std::max(worst, farthest_from_rigid(placement.rotation));
  }
  EXPECT_LE(std::max(worst, farthest_from_rigid(placement.rotation)), 1e-15);
  EXPECT_GT(placement.rotation.determinant(), 0);
}

TEST(Placement, CutsTheMotionOfHalfATurnAndKeepsItsAxis) {
  Random random(14);
  const Placement from = some_placement(random);
  for (int i = 0; i < samples(1000); ++i) {
    const Vector3d axis = random.direction();
    for (const double beyond : {-1e-3, -1e-9, -1e-15, 0.0, 1e-15, 1e-9, 1e-3}) {
      const Placement to{turn(std::numbers::pi + beyond, axis) * from.rotation, from.translation};
      const Vector3d rotation = motion_between(from, to).tail<3>();
      ASSERT_NEAR(rotation.norm(), 1e3, 1e-9);
      const double along = rotation.dot(axis) / 1e3;
      ASSERT_GE(std::abs(along), 1 - 1e-12);
      if (std::abs(beyond) > 1e-12) {
        ASSERT_EQ(along > 0, beyond < 0);
      }
    }
  }
  Matrix3d half;
  half << -1, 0, 0, 0, -1, 0, 0, 0, 1;
  const Vector6 way = motion_between(Placement{}, {half, Vector3d::Zero()});
  EXPECT_EQ(std::abs(way[5]), 1e3);
  EXPECT_EQ(way.head<5>().norm(), 0);
}

TEST(Placement, HasTheCutWhereLongMotionsEnd) {
  // Just below, the motion is whole; just above, it is cut: no step between.
  const Vector3d axis = Vector3d(1, 2, 2) / 3;
  const double at_cut = 2 * std::atan(500.0);
  for (const double angle : {at_cut - 1e-7, at_cut + 1e-7}) {
    const Vector3d rotation = motion_between({}, {turn(angle, axis), Vector3d::Zero()}).tail<3>();
    EXPECT_LE((rotation - 1e3 * axis).norm(), 0.05) << angle;
    EXPECT_LE(rotation.norm(), 1e3 * (1 + 1e-12));
  }
  const Placement long_turn{turn(2 * std::atan(400.0), axis), Vector3d::Zero()};
  EXPECT_LE((motion_between({}, long_turn).tail<3>() - 800 * axis).norm(), 1e-6);
}

TEST(Placement, IsMadeFromRigidPosesOnly) {
  Random random(15);
  const Placement placement = some_placement(random);
  const auto same = Placement::from(placement.isometry());
  ASSERT_TRUE(same);
  EXPECT_LE((same->rotation - placement.rotation).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(same->translation, placement.translation);

  Eigen::Isometry3d stretched = placement.isometry();
  stretched.linear() *= 1.001;
  EXPECT_FALSE(Placement::from(stretched));
  Eigen::Isometry3d nowhere = placement.isometry();
  nowhere.translation()[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Placement::from(nowhere));
}

}  // namespace
}  // namespace ist::test
