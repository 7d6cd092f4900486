#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "ist/mesh/nearest_point.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/random.h"

namespace ist {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;
using test::exact;

double exact_distance(const Eigen::Vector3d& p, const test::ExactPolygon& piece) {
  return std::sqrt(test::distance_squared(exact(p), piece).get_d());
}

// The point is on the triangle, on the feature that is named, and no other is nearer.
void expect_nearest(const Corners& triangle, const Eigen::Vector3d& from, double tolerance) {
  const NearestPoint nearest = nearest_on_triangle(triangle, from);
  ASSERT_TRUE(nearest.point.allFinite());
  const test::ExactPolygon piece = test::exact_triangle(triangle);
  EXPECT_LE(exact_distance(nearest.point, piece), tolerance);
  EXPECT_NEAR((from - nearest.point).norm(), exact_distance(from, piece), tolerance);
  ASSERT_GE(nearest.feature, 0);
  ASSERT_LE(nearest.feature, NearestPoint::kInside);
  if (nearest.feature == NearestPoint::kInside) return;
  const auto i = static_cast<std::size_t>(nearest.feature % 3);
  if (nearest.feature < 3) {
    EXPECT_EQ(nearest.point, triangle[i]);
  } else {
    const Eigen::Vector3d &a = triangle[i], &b = triangle[(i + 1) % 3];
    EXPECT_LE(exact_distance(nearest.point, test::exact_triangle({a, b, b})), tolerance);
  }
}

TEST(NearestOnTriangle, IsAsNearAsTheExactNearestPoint) {
  test::Random random(1);
  for (int i = 0; i < test::samples(5000); ++i) {
    const Corners triangle{random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)};
    expect_nearest(triangle, random.point(-2, 2), 1e-12);
  }
}

TEST(NearestOnTriangle, IsRightWherePointsLieOnCornersEdgesAndAboveThem) {
  test::Random random(2);
  for (int i = 0; i < test::samples(5000); ++i) {
    const Corners triangle{random.point_on_grid(-2, 2, 1), random.point_on_grid(-2, 2, 1),
                           random.point_on_grid(-2, 2, 1)};  // many of them degenerate
    expect_nearest(triangle, random.point_on_grid(-3, 3, 0.5), 1e-13);
  }
}

TEST(NearestOnTriangle, NamesTheFeature) {
  const Corners triangle{Eigen::Vector3d(0, 0, 0), {4, 0, 0}, {0, 4, 0}};
  const auto feature = [&](double x, double y) {
    return nearest_on_triangle(triangle, {x, y, 1}).feature;
  };
  EXPECT_EQ(feature(-1, -1), 0);
  EXPECT_EQ(feature(6, -1), 1);
  EXPECT_EQ(feature(-1, 6), 2);
  EXPECT_EQ(feature(2, -1), 3);
  EXPECT_EQ(feature(3, 3), 4);
  EXPECT_EQ(feature(-1, 2), 5);
  EXPECT_EQ(feature(1, 1), NearestPoint::kInside);
}

TEST(NearestOnTriangle, OfASegmentOrAPointIsThatOfTheSegmentOrThePoint) {
  test::Random random(3);
  for (int i = 0; i < test::samples(3000); ++i) {
    const Eigen::Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
    const Eigen::Vector3d from = random.point(-2, 2);
    expect_nearest({a, a, a}, from, 1e-15);
    expect_nearest({a, a, b}, from, 1e-13);
    expect_nearest({a, b, a}, from, 1e-13);
    expect_nearest({a, b, b}, from, 1e-13);
  }
}

// The three corners on a line but for rounding, in any order.
TEST(NearestOnTriangle, OfANeedleIsNearlyThatOfTheSegment) {
  test::Random random(4);
  for (int i = 0; i < test::samples(5000); ++i) {
    const Eigen::Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
    const Eigen::Vector3d between = a + random.uniform(0, 1) * (b - a);
    const Eigen::Vector3d from = random.point(-2, 2);
    expect_nearest({a, b, between}, from, 1e-7);
    expect_nearest({between, a, b}, from, 1e-7);
    expect_nearest({b, between, a}, from, 1e-7);
  }
}

TEST(NearestOnTriangle, OfASliverIsRightToAPartOfItsWidth) {
  test::Random random(5);
  for (int i = 0; i < test::samples(3000); ++i) {
    const Eigen::Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
    const Eigen::Vector3d c = a + random.uniform(0, 1) * (b - a) + 1e-6 * random.direction();
    expect_nearest({a, b, c}, random.point(-2, 2), 1e-9);
  }
}

// Points that are as near to the sliver as it is wide, and farther: the foot matters there.
TEST(NearestOnTriangle, OfAThinSliverIsAsNearAsTheExactNearestPoint) {
  test::Random random(6);
  for (int i = 0; i < test::samples(6000); ++i) {
    const double wide = std::pow(0.1, random.uniform(2, 8));
    Eigen::Vector3d at[3] = {random.point(-1, 1), random.point(-1, 1), {}};
    at[2] = at[0] + random.uniform(0, 1) * (at[1] - at[0]) + wide * random.direction();
    const Corners triangle = {at[i % 3], at[(i + 1) % 3], at[(i + 2) % 3]};
    const double u = random.uniform(0, 1), v = random.uniform(0, 1);
    const Eigen::Vector3d on = at[0] + std::min(u, v) * (at[1] - at[0]) +
                               (std::max(u, v) - std::min(u, v)) * (at[2] - at[0]);
    const double off = wide * std::pow(10.0, random.uniform(-2, 3));
    expect_nearest(triangle, on + off * random.direction(), 2e-15);
  }
}

}  // namespace
}  // namespace ist
