#include "ist/measure/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "ist/measure/occlusion.h"
#include "measure/body_pair.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Pose = Eigen::Isometry3d;

std::vector<PlacedContact> contacts_at(std::initializer_list<Vector> places) {
  std::vector<PlacedContact> contacts;
  for (const Vector& place : places) contacts.push_back({place});
  return contacts;
}

bool same(const ContactMatch& a, const ContactMatch& b) {
  return a.before == b.before && a.after == b.after && a.moved == b.moved;
}

TEST(PoseChange, Hinge_HasItsAxisAndItsAngle) {
  const Vector hinge(0, 80, -20), axis(1, 0, 0), chin(3, -40, -60);
  Random random(7301);
  for (int i = 0; i < samples(200); ++i) {
    const double angle = random.uniform(0.001, 3.1), along = random.uniform(-5, 5);
    const Pose before = pose_of(random.rotation(), random.point(-90, 90));
    const Eigen::AngleAxisd turn(angle, axis);
    const Pose after =
        Eigen::Translation3d(hinge + along * axis) * turn * Eigen::Translation3d(-hinge) * before;
    const PoseChange change = pose_change(before, after, chin);
    EXPECT_EQ(change.about, chin);
    EXPECT_NEAR(change.angle, angle, 1e-12);
    EXPECT_NEAR(change.along, along, 1e-11);
    EXPECT_LT((change.axis - axis).norm(), 1e-12);
    EXPECT_LT((change.rotation - angle * axis).norm(), 1e-12);
    ASSERT_TRUE(change.axis_point.has_value());
    // The axis runs along x. Its nearest point to the chin has the chin's x.
    EXPECT_LT((*change.axis_point - Vector(3, 80, -20)).norm(), 1e-9 / angle);
    const Vector moved = hinge + along * axis + turn * (chin - hinge);
    EXPECT_LT((change.translation - (moved - chin)).norm(), 1e-11);
  }
}

TEST(PoseChange, Translation_HasNoAxisPoint) {
  const Pose before = pose_of(Eigen::Matrix3d::Identity(), {1, 2, 3});
  const PoseChange change =
      pose_change(before, pose_of(Eigen::Matrix3d::Identity(), {1, 2, 1}), {50, 0, 0});
  EXPECT_EQ(change.translation, Vector(0, 0, -2));
  EXPECT_EQ(change.rotation, Vector(0, 0, 0));
  EXPECT_EQ(change.axis, Vector(0, 0, -1));
  EXPECT_EQ(change.along, 2);
  EXPECT_EQ(change.angle, 0);
  EXPECT_FALSE(change.axis_point.has_value());
}

TEST(PoseChange, OfOnePose_IsZero) {
  Random random(7303);
  for (int i = 0; i < samples(50); ++i) {
    const Pose pose = pose_of(random.rotation(), random.point(-9, 9));
    const PoseChange change = pose_change(pose, pose, random.point(-9, 9));
    EXPECT_LT(change.translation.norm(), 1e-13);
    EXPECT_LT(change.angle, 1e-14);
    EXPECT_LT(std::abs(change.along), 1e-13);
  }
}

TEST(PoseChange, BackAgain_IsTheOppositeTurn) {
  Random random(7305);
  for (int i = 0; i < samples(200); ++i) {
    const Pose one = pose_of(random.rotation(), random.point(-9, 9));
    const Pose other = pose_of(random.rotation(), random.point(-9, 9));
    const Vector about = random.point(-9, 9);
    const PoseChange there = pose_change(one, other, about);
    const PoseChange back = pose_change(other, one, about + there.translation);
    EXPECT_LT((back.translation + there.translation).norm(), 1e-12);
    if (there.angle > 3.1) continue;  // the sign of half a turn is a matter of rounding
    EXPECT_LT((back.rotation + there.rotation).norm(), 1e-11);
  }
}

TEST(PoseChange, RefusesWhatIsNoPoseAndNoPoint) {
  Pose mirror = Pose::Identity();
  mirror.linear()(0, 0) = -1;
  EXPECT_EQ(error_name([&] { (void)pose_change(mirror, Pose::Identity(), Vector::Zero()); }),
            "pose-invalid");
  EXPECT_EQ(error_name([&] { (void)pose_change(Pose::Identity(), mirror, Vector::Zero()); }),
            "pose-invalid");
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e16}) {
    EXPECT_EQ(error_name([&] {
                (void)pose_change(Pose::Identity(), Pose::Identity(), {0, bad, 0});
              }),
              "argument-invalid");
  }
}

TEST(ContactMatches, FindKeptLostAndNewContacts) {
  const auto before = contacts_at({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}});
  const auto after = contacts_at({{20.5, 0, 0}, {0, 0.25, 0}, {30, 0, 0}});
  const auto matches = match_contacts(before, after, 2);
  ASSERT_EQ(matches.size(), 4U);
  EXPECT_TRUE(same(matches[0], {0U, 1U, 0.25}));
  EXPECT_TRUE(same(matches[1], {1U, std::nullopt, 0}));
  EXPECT_TRUE(same(matches[2], {2U, 0U, 0.5}));
  EXPECT_TRUE(same(matches[3], {std::nullopt, 2U, 0}));
}

TEST(ContactMatches, TakeTheNearestFirst) {
  // The second contact is nearer to the only place than the first one.
  const auto matches =
      match_contacts(contacts_at({{0, 0, 0}, {1.5, 0, 0}}), contacts_at({{1, 0, 0}}), 2);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_FALSE(matches[0].after.has_value());
  EXPECT_EQ(matches[1].after, 0U);
}

TEST(ContactMatches, WithinCountsItsEnd) {
  const auto one = contacts_at({{0, 0, 0}}), other = contacts_at({{0, 0, 2}});
  EXPECT_EQ(match_contacts(one, other, 2).size(), 1U);
  EXPECT_EQ(match_contacts(one, other, std::nextafter(2.0, 0.0)).size(), 2U);
  EXPECT_EQ(match_contacts(one, one, 0).size(), 1U);
}

TEST(ContactMatches, KeepTeethApart) {
  const std::vector<PlacedContact> before{{{0, 0, 0}, 16}, {{1, 0, 0}, 0}};
  const std::vector<PlacedContact> after{{{0.1, 0, 0}, 17}, {{0.3, 0, 0}, 16}};
  const auto matches = match_contacts(before, after, 2);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].after, 1U) << "17 is nearer, but another tooth";
  EXPECT_EQ(matches[1].after, 0U) << "a contact without a tooth matches any";
}

TEST(ContactMatches, AnExchangeOfTheBites_ExchangesNewAndLost) {
  Random random(7307);
  for (int i = 0; i < samples(200); ++i) {
    // Whole numbers, so that many distances are equal.
    const auto some = [&] {
      std::vector<PlacedContact> contacts(static_cast<std::size_t>(random.uniform(0, 30)));
      for (PlacedContact& each : contacts) {
        each.centre = Vector(std::floor(random.uniform(0, 6)), std::floor(random.uniform(0, 6)), 0);
        each.tooth = static_cast<int>(random.uniform(0, 3));
      }
      return contacts;
    };
    const auto before = some(), after = some();
    const auto there = match_contacts(before, after, 2), back = match_contacts(after, before, 2);
    ASSERT_EQ(there.size(), back.size());
    for (const ContactMatch& match : there) {
      const ContactMatch exchanged{match.after, match.before, match.moved};
      EXPECT_EQ(std::count_if(back.begin(), back.end(),
                              [&](const ContactMatch& each) { return same(each, exchanged); }),
                1);
    }
  }
}

TEST(ContactMatches, OfOneBite_MatchEachContactWithItself) {
  const auto contacts = contacts_at({{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}});
  const auto matches = match_contacts(contacts, contacts, 2);
  ASSERT_EQ(matches.size(), 3U);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(same(matches[i], {i, i, 0}));
  EXPECT_TRUE(match_contacts({}, {}, 2).empty());
}

TEST(ContactMatches, RefuseWhatIsNoNumber) {
  const auto good = contacts_at({{0, 0, 0}}), bad = contacts_at({{0, std::nan(""), 0}});
  EXPECT_EQ(error_name([&] { (void)match_contacts(bad, good, 2); }), "argument-invalid");
  EXPECT_EQ(error_name([&] { (void)match_contacts(good, bad, 2); }), "argument-invalid");
  for (const double within : {-1.0, std::nan("")}) {
    EXPECT_EQ(error_name([&] { (void)match_contacts(good, good, within); }), "argument-invalid");
  }
}

// A plate that comes nearer to a ball by 0.25: so does each of its vertices, and each contact
// stays.
TEST(DistanceChange, OfAMovedPlate_IsItsWay) {
  BodyPair pair(box({-9, -9, -1}, {9, 9, 0}), box({-2, -2, 0}, {2, 2, 3}));
  const auto map = [&](double height) {
    return distance_map(pair.moving, pair.fixed, place({0, 0, height}), 10);
  };
  const auto change = distance_change(map(0.5), map(0.25));
  ASSERT_EQ(change.size(), pair.moving.triangles()->vertices.size());
  for (const double each : change) EXPECT_NEAR(each, -0.25, 1e-12);
  for (const double each : distance_change(map(0.5), map(0.5))) EXPECT_EQ(each, 0);
}

TEST(DistanceChange, IsUnknownBeyondTheReachAndWithOneSign) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto one = [](double distance, bool is_signed) {
    return SurfaceDistance{distance, Vector::Zero(), 0, is_signed, false};
  };
  const std::vector<SurfaceDistance> before{one(1, true), one(none, false), one(1, true)};
  const std::vector<SurfaceDistance> after{one(0.5, true), one(1, true), one(1, false)};
  const auto change = distance_change(before, after);
  EXPECT_EQ(change[0], -0.5);
  EXPECT_TRUE(std::isnan(change[1]));
  EXPECT_TRUE(std::isnan(change[2]));
  EXPECT_EQ(error_name([&] { (void)distance_change(before, {}); }), "argument-invalid");
}

}  // namespace
}  // namespace ist::test
