// Random poses: those of numpy's numbers, uniform, and the same in every order of asking.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/effort.h"
#include "sweep/pose_source.h"

namespace ist::test {
namespace {

using Turns = PoseBox::Turns;

PoseBox::Settings settings(Turns turns, double within = 0) {
  PoseBox::Settings box;
  box.seed = 7;
  box.count = 1'000'000'000'000;
  box.from = {-1, -2, -3};
  box.to = {1, 2, 3};
  box.turns = turns;
  box.within = Eigen::Vector3d::Constant(within);
  box.about = {1, 2, 3};
  return box;
}

Eigen::Isometry3d pose_of(const PoseBox& box, std::uint64_t index) {
  Eigen::Isometry3d pose;
  box.read(index, {&pose, 1});
  return pose;
}

void expect_near(const Eigen::Isometry3d& pose, const Eigen::Matrix<double, 3, 4>& known) {
  EXPECT_LT((pose.matrix().topRows<3>() - known).cwiseAbs().maxCoeff(), 4e-15) << pose.matrix();
  EXPECT_EQ(pose.matrix().row(3), Eigen::RowVector4d(0, 0, 0, 1));
}

// Made by numpy, with Generator(Philox(key=7, counter=[0, i, 0, 0])).
TEST(PoseBox, AnyTurnIsMadeOfNumpysNumbers) {
  Eigen::Matrix<double, 3, 4> known;
  known << -0.8528678381922485, -0.18774629303924922, -0.4872040435251959, 3.567977016647234,
      -0.4074182770164005, -0.34426935430555283, 0.8458658045098083, -0.779005674927747,
      -0.3265375906848524, 0.9199075720614861, 0.21712498873615083, 3.729175682808868;
  expect_near(pose_of(PoseBox(settings(Turns::kAny)), 3), known);
}

TEST(PoseBox, SmallTurnIsMadeOfNumpysNumbers) {
  Eigen::Matrix<double, 3, 4> known;
  known << 0.9983549523419086, -0.03359999496276352, -0.0464589009005553, 0.846390988720526,
      0.03021484402357863, 0.9969657040127945, -0.07173874980025613, 0.00173555903730982,
      0.04872835247590632, 0.07021698769368565, 0.9963408665232039, 0.7185920126462464;
  expect_near(pose_of(PoseBox(settings(Turns::kWithin, 5)), 12345678901), known);
}

// R = (I - A)^-1 (I + A), where A crosses with w / 2.
TEST(PoseBox, SmallTurnIsCayleys) {
  const PoseBox box(settings(Turns::kWithin, 90));
  double widest = 0;
  for (std::uint64_t i = 0; i < samples(std::uint64_t{1000}); ++i) {
    const Eigen::Matrix3d turn = pose_of(box, i).linear();
    const Eigen::Matrix3d inverse = (turn + Eigen::Matrix3d::Identity()).inverse();
    const Eigen::Matrix3d a = (turn - Eigen::Matrix3d::Identity()) * inverse;
    ASSERT_LT((a + a.transpose()).cwiseAbs().maxCoeff(), 1e-12);
    for (const double half : {a(2, 1), a(0, 2), a(1, 0)}) {
      widest = std::max(widest, std::abs(2 * half) * 180 / M_PI);
    }
  }
  EXPECT_LE(widest, 90);
  EXPECT_GT(widest, 88);
}

TEST(PoseBox, WithoutTurnsOnlyMoves) {
  const PoseBox box(settings(Turns::kNone));
  Eigen::Vector3d least = box.count() * Eigen::Vector3d::Ones(), most = -least;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Eigen::Isometry3d pose = pose_of(box, i);
    ASSERT_EQ(pose.linear(), Eigen::Matrix3d::Identity());
    least = least.cwiseMin(pose.translation());
    most = most.cwiseMax(pose.translation());
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double end = axis + 1;
    EXPECT_GE(least[axis], -end);
    EXPECT_LT(least[axis], -0.99 * end);
    EXPECT_LT(most[axis], end);
    EXPECT_GT(most[axis], 0.99 * end);
  }
}

TEST(PoseBox, EveryPoseIsRigidToRounding) {
  for (const Turns turns : {Turns::kAny, Turns::kWithin}) {
    const PoseBox box(settings(turns, 90));
    for (std::uint64_t i = 0; i < samples(std::uint64_t{2000}); ++i) {
      const Eigen::Matrix3d turn = pose_of(box, i).linear();
      const Eigen::Matrix3d product = turn.transpose() * turn;
      ASSERT_LT((product - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 3e-15);
      ASSERT_NEAR(turn.determinant(), 1, 3e-15);
    }
  }
}

// A turn leaves the point `about`, up to the move.
TEST(PoseBox, TurnsAboutThePoint) {
  PoseBox::Settings still = settings(Turns::kAny);
  still.from = still.to = Eigen::Vector3d::Zero();
  const PoseBox box(still);
  for (std::uint64_t i = 0; i < samples(std::uint64_t{100}); ++i) {
    EXPECT_LT((pose_of(box, i) * still.about - still.about).cwiseAbs().maxCoeff(), 4e-15);
  }
}

// The angle of a uniform turn is below t with probability (t - sin t) / pi; its axis is uniform.
TEST(PoseBox, AnyTurnIsUniform) {
  constexpr std::uint64_t kPoses = 40000;
  const PoseBox box(settings(Turns::kAny));
  std::vector<double> angles;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero(), squares = Eigen::Matrix3d::Zero();
  for (std::uint64_t i = 0; i < kPoses; ++i) {
    const Eigen::Matrix3d turn = pose_of(box, i).linear();
    angles.push_back(std::acos(std::clamp((turn.trace() - 1) / 2, -1.0, 1.0)));
    sum += turn;
    squares += turn.cwiseProduct(turn);
  }
  std::sort(angles.begin(), angles.end());
  double apart = 0;  // of the distributions: Kolmogorov's statistic
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double expected = (angles[i] - std::sin(angles[i])) / M_PI;
    apart = std::max(apart, std::abs(expected - (static_cast<double>(i) + 0.5) / kPoses));
  }
  EXPECT_LT(apart, 1.63 / std::sqrt(kPoses));
  EXPECT_LT((sum / kPoses).cwiseAbs().maxCoeff(), 4 * std::sqrt(1.0 / 3 / kPoses));
  const Eigen::Matrix3d third = Eigen::Matrix3d::Constant(1.0 / 3);
  EXPECT_LT((squares / kPoses - third).cwiseAbs().maxCoeff(), 4 * 0.3 / std::sqrt(kPoses));
}

TEST(PoseBox, APoseDependsOnItsNumberAlone) {
  const PoseBox box(settings(Turns::kAny));
  std::vector<Eigen::Isometry3d> together(50);
  box.read(999'999'999'000, together);
  for (std::size_t i = together.size(); i-- > 0;) {
    EXPECT_EQ(pose_of(box, 999'999'999'000 + i).matrix(), together[i].matrix());
  }
  PoseBox::Settings other = settings(Turns::kAny);
  other.seed = 8;
  EXPECT_NE(pose_of(PoseBox(other), 5).matrix(), pose_of(box, 5).matrix());
}

}  // namespace
}  // namespace ist::test
