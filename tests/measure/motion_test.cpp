#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ist/base/angles.h"
#include "ist/measure/first_contact.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/errors.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Pose = Eigen::Isometry3d;
constexpr double kPi = std::numbers::pi;

double distance_of(const Pose& a, const Pose& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

TEST(Angles, AreThoseOfLibm) {
  Random random(71);
  for (int i = 0; i < samples(2000); ++i) {
    const double angle = random.uniform(-100, 100) * std::ldexp(1.0, -static_cast<int>(i % 60));
    const auto [sine, cosine] = sine_cosine(angle);
    const double slack = 2e-15 * std::max(1.0, std::abs(angle));
    EXPECT_NEAR(sine, std::sin(angle), slack);
    EXPECT_NEAR(cosine, std::cos(angle), slack);
    if (std::abs(angle) < 1) {
      EXPECT_NEAR(sine, std::sin(angle), 1e-15 * std::abs(angle));
    }
    const double y = random.uniform(0, 1), x = random.uniform(-1, 1);
    EXPECT_NEAR(angle_of(y, x), std::atan2(y, x), 1e-13);
  }
  EXPECT_EQ(angle_of(0, 0), 0);
  EXPECT_NEAR(angle_of(0, -1), kPi, 1e-15);
}

TEST(Motion, GoesFromOnePoseToTheOther) {
  Random random(73);
  for (int i = 0; i < samples(300); ++i) {
    const Pose from = pose_of(random.rotation(), random.point(-9, 9));
    const double angle = i % 3 == 0 ? kPi : std::ldexp(random.uniform(0, 3), -(i % 50));
    const Pose by = pose_of(Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix(),
                            random.point(-9, 9));
    const Pose to = by * from;
    const Motion motion = Motion::between(from, to);
    EXPECT_LT(distance_of(motion.at(0), from), 1e-13);
    EXPECT_LT(distance_of(motion.at(1), to), 1e-12) << angle;
    // Half of it twice is all of it.
    const Pose half = motion.at(0.5) * from.inverse();
    EXPECT_LT(distance_of(half * half * from, to), 1e-12) << angle;
  }
}

TEST(Motion, OfATranslationIsStraight) {
  const Pose from = pose_of(Eigen::Matrix3d::Identity(), {1, 2, 3});
  const Motion motion = Motion::between(from, pose_of(Eigen::Matrix3d::Identity(), {1, 2, -5}));
  EXPECT_LT((motion.at(0.25).translation() - Vector(1, 2, 1)).norm(), 1e-15);
  EXPECT_EQ(motion.at(0.25).linear(), Eigen::Matrix3d::Identity());
  EXPECT_NEAR(motion.longest_way(std::vector<Vector>{{0, 0, 0}, {100, 0, 0}}), 8, 1e-14);
  const Motion none = Motion::between(from, from);
  EXPECT_EQ(none.longest_way(std::vector<Vector>{{5, 5, 5}}), 0);
  EXPECT_EQ(distance_of(none.at(0.7), from), 0);
}

TEST(Motion, OfAScrewTurnsAsOftenAsItIsTold) {
  const Vector point(1, 0, 0);
  const Motion motion = Motion::screw(Pose::Identity(), point, {0, 0, 2}, 2.5 * kPi, 10);
  // A quarter of a turn more than one: (3, 0, 0), 2 from the axis, goes to (1, 2, 10).
  EXPECT_LT((motion.at(1) * Vector(3, 0, 0) - Vector(1, 2, 10)).norm(), 1e-13);
  EXPECT_LT((motion.at(0.4) * Vector(3, 0, 0) - Vector(-1, 0, 4)).norm(), 1e-13);
  EXPECT_NEAR(motion.longest_way(std::vector<Vector>{{1, 0, 0}, {3, 0, 7}}),
              std::hypot(10, 2.5 * kPi * 2), 1e-12);
}

TEST(Motion, SaysHowFarItsPointsGo) {
  Random random(79);
  for (int i = 0; i < samples(100); ++i) {
    const Motion motion = Motion::between(pose_of(random.rotation(), random.point(-3, 3)),
                                          pose_of(random.rotation(), random.point(-3, 3)));
    const Vector point = random.point(-2, 2);
    double way = 0;
    constexpr int kSteps = 2000;
    for (int k = 0; k < kSteps; ++k) {
      way += (motion.at((k + 1.0) / kSteps) * point - motion.at(double(k) / kSteps) * point).norm();
    }
    EXPECT_NEAR(motion.longest_way(std::vector<Vector>{point}), way, 1e-5 * (1 + way));
  }
}

TEST(Motion, HasADirectionOfAnyLength) {
  const Vector axis(1, 2, 2);
  const auto end = [&](double length) {
    return Motion::screw(Pose::Identity(), {1, 0, 0}, length * axis, 0.5, 3).at(1);
  };
  for (const double length : {1e-300, 1e-170, 1e-20, 1e20, 1e170, 1e300}) {
    EXPECT_LE((end(length).matrix() - end(1).matrix()).cwiseAbs().maxCoeff(), 1e-15) << length;
  }
  Pose near = Pose::Identity(), far = Pose::Identity();
  far.translation() = Vector(0, 3e-200, 4e-200);
  const Vector end_of_way = Motion::between(near, far).at(1).translation();
  EXPECT_LE(((end_of_way - far.translation()) / 1e-200).norm(), 1e-14);
}

TEST(Motion, RefusesWhatIsNone) {
  Pose sheared = Pose::Identity();
  sheared(0, 1) = 1;
  const auto screw = [](const Vector& direction, double angle) {
    return error_name([&] {
      static_cast<void>(Motion::screw(Pose::Identity(), {0, 0, 0}, direction, angle, 1));
    });
  };
  EXPECT_EQ(error_name([&] { static_cast<void>(Motion::between(sheared, Pose::Identity())); }),
            "pose-invalid");
  EXPECT_EQ(error_name([&] { static_cast<void>(Motion::between(Pose::Identity(), sheared)); }),
            "pose-invalid");
  EXPECT_EQ(screw({0, 0, 0}, 1), "argument-invalid");
  EXPECT_EQ(screw({0, 0, 1}, std::nan("")), "argument-invalid");
  EXPECT_EQ(screw({0, HUGE_VAL, 1}, 1), "argument-invalid");
  EXPECT_EQ(screw({0, 0, 1}, 1), "none");
}

}  // namespace
}  // namespace ist::test
