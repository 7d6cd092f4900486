#include "ist/base/symmetric_eigen.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/effort.h"
#include "support/random.h"

namespace ist {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d symmetric(double xx, double xy, double xz, double yy, double yz, double zz) {
  Matrix3d matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return matrix;
}

// A matrix with these eigenvalues along the columns of a rotation.
Matrix3d turned(const Vector3d& values, const Matrix3d& axes) {
  const Matrix3d matrix = axes * values.asDiagonal() * axes.transpose();
  return symmetric(matrix(0, 0), matrix(0, 1), matrix(0, 2), matrix(1, 1), matrix(1, 2),
                   matrix(2, 2));
}

Matrix3d random_axes(test::Random& random) {
  const Vector3d x = random.direction();
  const Vector3d y = x.cross(random.direction()).normalized();
  Matrix3d axes;
  axes << x, y, x.cross(y);
  return axes;
}

void expect_eigen(const Matrix3d& matrix, const Vector3d& values) {
  const SymmetricEigen eigen = symmetric_eigen(matrix);
  const double size = values.cwiseAbs().maxCoeff();
  EXPECT_LE((eigen.values - values).cwiseAbs().maxCoeff(), 1e-14 * size)
      << eigen.values.transpose() << " for " << values.transpose();
  EXPECT_LE(eigen.values[0], eigen.values[1]);
  EXPECT_LE(eigen.values[1], eigen.values[2]);
  const Matrix3d& v = eigen.vectors;
  EXPECT_LE((v.transpose() * v - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
  const Matrix3d left = matrix * v - v * eigen.values.asDiagonal();
  EXPECT_LE(left.cwiseAbs().maxCoeff(), 1e-14 * size) << matrix;
}

TEST(SymmetricEigen, OfKnownMatrices) {
  expect_eigen(Matrix3d::Zero(), {0, 0, 0});
  expect_eigen(Matrix3d::Identity(), {1, 1, 1});
  expect_eigen(symmetric(3, 0, 0, 1, 0, 2), {1, 2, 3});
  expect_eigen(symmetric(0, 1, 0, 0, 0, 5), {-1, 1, 5});
  expect_eigen(symmetric(2, 1, 1, 2, 1, 2), {1, 1, 4});
  expect_eigen(Matrix3d::Constant(1), {0, 0, 3});
  expect_eigen(symmetric(2, -1, 0, 2, -1, 2), {2 - std::sqrt(2.0), 2, 2 + std::sqrt(2.0)});
  expect_eigen(symmetric(-7, 0, 0, -7, 0, -9), {-9, -7, -7});
}

TEST(SymmetricEigen, FindsTheNormalOfAPlane) {
  const Vector3d normal = Vector3d(1, 2, 2) / 3, u = Vector3d(2, 1, -2) / 3, w = normal.cross(u);
  Matrix3d axes;
  axes << normal, u, w;
  const SymmetricEigen eigen = symmetric_eigen(turned({0, 1, 30}, axes));
  EXPECT_NEAR(std::abs(eigen.vectors.col(0).dot(normal)), 1, 1e-15);
  EXPECT_NEAR(std::abs(eigen.vectors.col(2).dot(w)), 1, 1e-15);
}

TEST(SymmetricEigen, OfRandomMatricesOfAllSizesAndShapes) {
  test::Random random(1);
  for (int i = 0; i < test::samples(2000); ++i) {
    const double size = std::ldexp(1.0, static_cast<int>(random.below(200)) - 100);
    Vector3d values;
    for (double& value : values) {
      // Some equal, some far smaller than others, some of them 0.
      value = size * std::ldexp(random.uniform(-1, 1), -static_cast<int>(random.below(3) * 20));
      if (random.below(5) == 0) value = size;
      if (random.below(7) == 0) value = 0;
    }
    std::sort(values.begin(), values.end());
    expect_eigen(turned(values, random_axes(random)), values);
  }
}

// Numbers whose squares and products leave double's range only as far as they may.
TEST(SymmetricEigen, OfExtremeMatrices) {
  expect_eigen(symmetric(1, 1e-200, 1e-200, 2, 1e-200, 3), {1, 2, 3});
  expect_eigen(symmetric(1e-150, 1e-150, 0, 1e-150, 0, 1), {0, 2e-150, 1});
  expect_eigen(symmetric(0, 1e-300, 0, 0, 0, 0), {-1e-300, 0, 1e-300});
}

TEST(SymmetricEigen, ReadsTheUpperTriangleAlone) {
  Matrix3d matrix = symmetric(2, 1, 1, 2, 1, 2);
  const SymmetricEigen whole = symmetric_eigen(matrix);
  matrix(1, 0) = matrix(2, 0) = matrix(2, 1) = 77;
  const SymmetricEigen upper = symmetric_eigen(matrix);
  EXPECT_EQ(upper.values, whole.values);
  EXPECT_EQ(upper.vectors, whole.vectors);
}

}  // namespace
}  // namespace ist
