#include "ist/base/direction.h"

#include <gtest/gtest.h>

#include <limits>

namespace ist {
namespace {

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

}  // namespace
}  // namespace ist
