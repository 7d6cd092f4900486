#include "ist/base/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "support/effort.h"
#include "support/exact.h"
#include "support/random.h"
#include "support/rigid_pose.h"

namespace ist {
namespace {

Eigen::Isometry3d pose_of(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation;
  pose.translation() = translation;
  return pose;
}

Eigen::Matrix3d random_rotation(test::Random& random) {
  return Eigen::AngleAxisd(random.uniform(-3, 3), random.direction()).toRotationMatrix();
}

Eigen::Isometry3d still(const Eigen::Matrix3d& rotation) {
  return pose_of(rotation, Eigen::Vector3d::Zero());
}

bool says(const Eigen::Matrix3d& rotation, const char* part) {
  return std::string(why_not_rigid(still(rotation))).find(part) != std::string::npos;
}

// A symmetric matrix near the identity, of trace 3.
Eigen::Matrix3d stretch_without_scale(test::Random& random, double size) {
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Zero();
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      stretch(row, column) = stretch(column, row) = random.uniform(-size, size);
    }
  }
  const double mean = stretch.trace() / 3;
  for (int i = 0; i < 3; ++i) stretch(i, i) += 1 - mean;
  return stretch;
}

// The largest entry of |RᵀR - I|, its sums exact.
double distance_from_orthonormal(const Eigen::Matrix3d& rotation) {
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const mpq_class entry =
          dot(test::exact(rotation.col(i)), test::exact(rotation.col(j))) - (i == j ? 1 : 0);
      largest = std::max(largest, std::abs(entry.get_d()));
    }
  }
  return largest;
}

TEST(ProjectToRigid, IdentityAndQuarterTurnsComeBackBitForBit) {
  int turns = 0;
  for (int code = 0; code < 6 * 8; ++code) {  // each order of the axes, each mirroring
    constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                   {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 3; ++i) rotation(i, kOrders[code / 8][i]) = (code >> i & 1) != 0 ? -1 : 1;
    const Eigen::Isometry3d pose = pose_of(rotation, {0.1, -1e9, 1e-300});
    const auto rigid = project_to_rigid(pose);
    ASSERT_EQ(rigid.has_value(), rotation.determinant() > 0);
    if (!rigid) continue;
    ++turns;
    EXPECT_EQ(rigid->matrix(), pose.matrix());
  }
  EXPECT_EQ(turns, 24);
}

TEST(ProjectToRigid, RotationsNearlyOrthonormalBecomeSoAndStayNear) {
  test::Random random(1);
  for (int i = 0; i < test::samples(300); ++i) {
    const double error = i % 3 == 0 ? 0 : (i % 3 == 1 ? 1e-9 : 1e-6);
    Eigen::Matrix3d rotation = random_rotation(random);
    for (int k = 0; k < 9; ++k) rotation(k) += random.uniform(-error, error);
    const Eigen::Vector3d translation = random.point(-100, 100);
    const auto rigid = project_to_rigid(pose_of(rotation, translation));
    ASSERT_TRUE(rigid);
    EXPECT_LE(distance_from_orthonormal(rigid->linear()), 1e-15);
    EXPECT_LE((rigid->linear() - rotation).norm(), 3 * error + 1e-15);
    EXPECT_EQ(rigid->translation(), translation);
    EXPECT_EQ(rigid->matrix().row(3), Eigen::RowVector4d(0, 0, 0, 1));
  }
}

TEST(ProjectToRigid, IsTheFormulaOfTheGuarantee) {
  test::Random random(5);
  for (int i = 0; i < test::samples(300); ++i) {
    Eigen::Matrix3d rotation = random_rotation(random);
    for (int k = 0; k < 9; ++k) rotation(k) += random.uniform(-2e-6, 2e-6);
    const Eigen::Isometry3d pose = pose_of(rotation, random.point(-100, 100));
    EXPECT_EQ(project_to_rigid(pose).value().matrix(), test::rigid_pose(pose).matrix());
  }
}

TEST(ProjectToRigid, TheNearestRotationIsThePolarFactor) {
  test::Random random(2);
  for (int i = 0; i < test::samples(100); ++i) {
    // R·S with S symmetric and near the identity has the polar factor R.
    const Eigen::Matrix3d rotation = random_rotation(random);
    Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
    for (int row = 0; row < 3; ++row) {
      for (int column = row; column < 3; ++column) {
        const double entry = random.uniform(-3e-6, 3e-6);
        stretch(row, column) += entry;
        if (row != column) stretch(column, row) += entry;
      }
    }
    const auto rigid = project_to_rigid(pose_of(rotation * stretch, Eigen::Vector3d::Zero()));
    ASSERT_TRUE(rigid);
    EXPECT_LE((rigid->linear() - rotation).cwiseAbs().maxCoeff(), 2e-15);
  }
}

TEST(ProjectToRigid, RefusesWhatIsFartherThanTheToleranceFromOrthonormal) {
  for (int k = 0; k < 9; ++k) {
    for (const double sign : {-1.0, 1.0}) {
      Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
      rotation(k) += sign * 4.9e-4;  // RᵀR moves by twice as much on the diagonal
      EXPECT_TRUE(project_to_rigid(still(rotation))) << k;
      EXPECT_STREQ(why_not_rigid(still(rotation)), "") << k;
      rotation = Eigen::Matrix3d::Identity();
      rotation(k) += sign * 1.1e-3;
      EXPECT_FALSE(project_to_rigid(still(rotation))) << k;
      EXPECT_TRUE(says(rotation, "farther than 1e-3 from orthonormal")) << k;
    }
  }
  EXPECT_FALSE(project_to_rigid(still(Eigen::Matrix3d::Zero())));
  EXPECT_TRUE(says(Eigen::Matrix3d::Zero(), "orthonormal"));
  EXPECT_TRUE(says(Eigen::Matrix3d::Constant(1e200), "orthonormal"));
}

// A pose that is rough in all ways at once: R·S with S symmetric and without a scale.
TEST(ProjectToRigid, RoughRotationsBecomeTheirPolarFactor) {
  test::Random random(6);
  int rough = 0;
  for (int i = 0; i < test::samples(300); ++i) {
    const Eigen::Matrix3d rotation = random_rotation(random);
    const Eigen::Isometry3d pose =
        pose_of(rotation * stretch_without_scale(random, 3e-4), random.point(-100, 100));
    const auto rigid = project_to_rigid(pose);
    ASSERT_TRUE(rigid) << why_not_rigid(pose);
    EXPECT_LE((rigid->linear() - rotation).cwiseAbs().maxCoeff(), 4e-15);
    EXPECT_LE(distance_from_orthonormal(rigid->linear()), 1e-15);
    EXPECT_EQ(rigid->matrix(), test::rigid_pose(pose).matrix());
    rough += rotation_error(pose) > 3e-4 ? 1 : 0;
  }
  EXPECT_GT(rough, test::samples(300) / 4);
}

TEST(ProjectToRigid, AProductOfManyFloatRotationsIsAccepted) {
  const Eigen::Matrix3f step =
      Eigen::AngleAxisf(0.01F, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  Eigen::Matrix3f product = step;
  for (int i = 1; i < 3000; ++i) product = product * step;
  const Eigen::Isometry3d pose = still(product.cast<double>());
  EXPECT_GT(rotation_error(pose), 1e-5);
  const auto rigid = project_to_rigid(pose);
  ASSERT_TRUE(rigid) << rotation_error(pose);
  EXPECT_LE((rigid->linear() - pose.linear()).cwiseAbs().maxCoeff(), rotation_error(pose));
}

TEST(ProjectToRigid, RefusesAScaleAndNamesIt) {
  test::Random random(7);
  for (int i = 0; i < test::samples(40); ++i) {
    const Eigen::Matrix3d rotation = random_rotation(random);
    for (const double scale : {1 + 9e-6, 1 - 9e-6, 1 + 4e-6, 1.0}) {
      const auto rigid = project_to_rigid(still(scale * rotation));
      ASSERT_TRUE(rigid) << scale;
      EXPECT_LE((rigid->linear() - rotation).cwiseAbs().maxCoeff(), 2e-15);
    }
    for (const double scale :
         {1 + 1.1e-5, 1 - 1.1e-5, 1.0001, 0.9996, 1.0005, 1.001, 0.99, 2.0, 0.001, 25.4, 1e9}) {
      EXPECT_FALSE(project_to_rigid(still(scale * rotation))) << scale;
      EXPECT_TRUE(says(scale * rotation, "scale")) << scale;
    }
    // Beside a scale a rotation may be rough: a scale is what all directions share.
    const Eigen::Matrix3d rough = rotation * stretch_without_scale(random, 1e-4);
    EXPECT_TRUE(project_to_rigid(still((1 + 5e-6) * rough)));
    EXPECT_TRUE(says(1.0003 * rough, "scale"));
    EXPECT_TRUE(says(0.9997 * rough, "scale"));
    EXPECT_TRUE(says(3 * rough, "scale"));
  }
}

TEST(ProjectToRigid, NamesWhatElseIsWrong) {
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad(3, 0) = 0.1;
  EXPECT_NE(std::string(why_not_rigid(bad)).find("last row"), std::string::npos);
  bad(0, 0) = std::nan("");
  EXPECT_NE(std::string(why_not_rigid(bad)).find("not finite"), std::string::npos);
  EXPECT_TRUE(says(Eigen::Vector3d(1, 1, -1).asDiagonal(), "mirrors"));
  EXPECT_TRUE(says(Eigen::Vector3d(2, 2, -2).asDiagonal(), "mirrors"));
}

TEST(RotationError, IsTheLargestEntryOfTheGramMatrixLessOne) {
  test::Random random(8);
  EXPECT_EQ(rotation_error(Eigen::Isometry3d::Identity()), 0);
  for (int i = 0; i < test::samples(100); ++i) {
    Eigen::Matrix3d rotation = random_rotation(random);
    const double size = i % 2 == 0 ? 1e-4 : 0.5;
    for (int k = 0; k < 9; ++k) rotation(k) += random.uniform(-size, size);
    EXPECT_NEAR(rotation_error(pose_of(rotation, random.point(-1e9, 1e9))),
                distance_from_orthonormal(rotation), 1e-14);
  }
  for (const double bad : {std::nan(""), HUGE_VAL, 1e200}) {
    for (int k = 0; k < 9; ++k) {
      Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
      rotation(k) = bad;
      EXPECT_EQ(rotation_error(still(rotation)), HUGE_VAL) << bad << " at " << k;
    }
  }
}

TEST(ProjectToRigid, RefusesMirrorings) {
  test::Random random(3);
  for (int i = 0; i < test::samples(20); ++i) {
    const Eigen::Matrix3d mirrored = -random_rotation(random);
    EXPECT_FALSE(project_to_rigid(pose_of(mirrored, Eigen::Vector3d::Zero())));
  }
}

TEST(ProjectToRigid, RefusesNumbersThatAreNotFiniteWhereverTheyAre) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    for (int k = 0; k < 16; ++k) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.matrix().data()[k] = bad;
      EXPECT_FALSE(project_to_rigid(pose)) << bad << " at " << k;
    }
  }
}

TEST(ProjectToRigid, RefusesALastRowThatIsNoRigidMotions) {
  for (int column = 0; column < 4; ++column) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.matrix()(3, column) += 1e-12;
    EXPECT_FALSE(project_to_rigid(pose)) << column;
  }
}

// The product in rational numbers, and how far the composed pose is from it.
TEST(ComposeRigid, IsRightToTheDriftThatIsStated) {
  constexpr double kUnit = 0x1p-53;
  test::Random random(4);
  for (int i = 0; i < test::samples(300); ++i) {
    const auto motion = [&random] {
      const Eigen::Matrix3d rotation = random_rotation(random);
      return project_to_rigid(pose_of(rotation, random.point(-100, 100))).value();
    };
    const Eigen::Isometry3d first = motion(), second = motion();
    const auto composed = compose_rigid(second, first);
    ASSERT_TRUE(composed);
    EXPECT_LE(distance_from_orthonormal(composed->linear()), 1e-15);
    const auto row = [&second](int k) {
      return test::exact(Eigen::Vector3d(second.linear().row(k).transpose()));
    };
    Eigen::Vector3d shifted;
    Eigen::Matrix3d turned;  // the error of the rotation
    for (int k = 0; k < 3; ++k) {
      const mpq_class place =
          dot(row(k), test::exact(first.translation())) + mpq_class(second.translation()[k]);
      shifted[k] = mpq_class(composed->translation()[k] - place).get_d();
      for (int j = 0; j < 3; ++j) {
        turned(k, j) =
            mpq_class(composed->linear()(k, j) - dot(row(k), test::exact(first.linear().col(j))))
                .get_d();
      }
    }
    const Eigen::Matrix3d turn = composed->linear().transpose() * turned;
    EXPECT_LE((turn - turn.transpose()).norm() / std::sqrt(8.0), 20 * kUnit);
    EXPECT_LE(shifted.norm(),
              8 * kUnit * (first.translation().norm() + second.translation().norm()));
  }
}

TEST(ComposeRigid, RefusesWhatIsNoRigidMotion) {
  const Eigen::Isometry3d rigid = Eigen::Isometry3d::Identity();
  EXPECT_TRUE(compose_rigid(rigid, rigid));
  Eigen::Isometry3d stretched = rigid, projective = rigid, endless = rigid;
  stretched(0, 0) = 1.001;
  projective(3, 1) = 0.5;
  endless(2, 3) = std::numeric_limits<double>::infinity();
  for (const Eigen::Isometry3d& bad : {stretched, projective, endless}) {
    EXPECT_FALSE(compose_rigid(rigid, bad));
    EXPECT_FALSE(compose_rigid(bad, rigid));
  }
}

}  // namespace
}  // namespace ist
