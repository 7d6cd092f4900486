#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "ist/base/compensated.h"
#include "ist/base/direction.h"
#include "ist/base/symmetric_eigen.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/random.h"

namespace ist {
namespace {

constexpr double kUnit = 0x1p-53;

double at_scale(test::Random& random, int largest_exponent) {
  return std::ldexp(random.uniform(-1, 1),
                    static_cast<int>(random.below(static_cast<std::uint32_t>(largest_exponent))));
}

TEST(CompensatedSum, FindsWhatAPlainSumLoses) {
  CompensatedSum sum;
  for (const double term : {1e16, 1.0, -1e16}) sum.add(term);
  EXPECT_EQ(sum.value(), 1.0);
  CompensatedSum product;
  product.add_product(1 + 0x1p-30, 1 - 0x1p-30);
  product.add(-1);
  EXPECT_EQ(product.value(), -0x1p-60);
}

TEST(CompensatedSum, StaysWithinItsBoundOnSumsThatNearlyCancel) {
  test::Random random(1);
  for (int round = 0; round < test::samples(200); ++round) {
    const std::size_t half = 2 + random.below(50);
    CompensatedSum sum;
    mpq_class exact = 0, magnitude = 0;
    const auto add = [&](double term) {
      sum.add(term);
      exact += mpq_class(term);
      magnitude += abs(mpq_class(term));
    };
    for (std::size_t i = 0; i < half; ++i) {
      const double term = at_scale(random, 60);
      add(term);
      add(-term + random.uniform(-1, 1) * 1e-3);  // condition numbers up to 1e20
    }
    const double n = 2.0 * static_cast<double>(half);
    const mpq_class bound =
        mpq_class(kUnit) * abs(exact) + mpq_class(n * n * kUnit * kUnit) * magnitude;
    EXPECT_LE(abs(mpq_class(sum.value()) - exact), bound);
  }
}

TEST(CompensatedSum, StaysWithinItsBoundOnDotProductsThatNearlyCancel) {
  test::Random random(2);
  for (int round = 0; round < test::samples(200); ++round) {
    const std::size_t half = 1 + random.below(50);
    CompensatedSum sum;
    mpq_class exact = 0, magnitude = 0;
    const auto add = [&](double a, double b) {
      sum.add_product(a, b);
      const mpq_class product = mpq_class(a) * mpq_class(b);
      exact += product;
      magnitude += abs(product);
    };
    for (std::size_t i = 0; i < half; ++i) {
      const double a = at_scale(random, 40), b = at_scale(random, 40);
      add(a, b);
      add(-a * (1 + 0x1p-50), b * (1 - 0x1p-50));
    }
    const double n = 4.0 * static_cast<double>(half);  // a product is two terms
    const mpq_class bound =
        mpq_class(kUnit) * abs(exact) + mpq_class(n * n * kUnit * kUnit) * magnitude;
    EXPECT_LE(abs(mpq_class(sum.value()) - exact), bound);
  }
}

TEST(CompensatedSum, ADeterminantOfTwoProductsIsRightToTheLastBitButOne) {
  test::Random random(3);
  for (int round = 0; round < test::samples(10'000); ++round) {
    const double a = random.uniform(0.5, 2), b = random.uniform(0.5, 2), c = random.uniform(0.5, 2);
    const double d = b * c / a;  // a·d - b·c is all rounding
    CompensatedSum sum;
    sum.add_product(a, d);
    sum.add_product(-b, c);
    const mpq_class exact = mpq_class(a) * mpq_class(d) - mpq_class(b) * mpq_class(c);
    EXPECT_LE(abs(mpq_class(sum.value()) - exact), mpq_class(2 * kUnit) * abs(exact));
  }
}

TEST(CompensatedSum, NothingIsZero) { EXPECT_EQ(CompensatedSum().value(), 0.0); }

using Vector = Eigen::Vector3d;

TEST(Direction, OfAnyLengthHasTheSameUnitVector) {
  const Vector v(3, -4, 12);  // 13 long
  for (const double by : {5e-300, 1e-200, 1e-160, 1e-3, 1.0, 1e3, 1e160, 1e300}) {
    const auto found = direction_of(by * v);
    ASSERT_TRUE(found) << by;
    EXPECT_LE((found->unit - v / 13).cwiseAbs().maxCoeff(), 2e-16) << by;
    EXPECT_NEAR(found->length / by, 13, 1e-14) << by;
  }
  const auto least = direction_of({0, 0, -5e-324});
  ASSERT_TRUE(least);
  EXPECT_EQ(least->unit, Vector(0, 0, -1));
}

TEST(Direction, KeepsTheBitsOfAnOrdinaryVector) {
  const Vector v(0.1, 0.7, -0.3);
  const double length = length_in_order(v);
  EXPECT_EQ(direction_of(v)->unit, scaled(1 / length, v));
  EXPECT_EQ(direction_of(v)->length, length);
}

TEST(Direction, OfNothingIsNone) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const Vector& v : {Vector(0, 0, 0), Vector(0, kInfinite, 1), Vector(1, kNaN, 1),
                          Vector(kNaN, 0, 0), Vector(-kInfinite, 0, 0)}) {
    EXPECT_FALSE(direction_of(v)) << v.transpose();
  }
}

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
