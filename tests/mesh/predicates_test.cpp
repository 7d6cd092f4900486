#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ist/mesh/orientation.h"
#include "ist/mesh/triangles_meet.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/exact.h"

namespace ist::test {
namespace {

int exact_sign(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
               const Eigen::Vector3d& d) {
  const ExactPoint from_d = exact(d);
  return sgn(dot(exact(a) - from_d, cross(exact(b) - from_d, exact(c) - from_d)));
}

int exact_sign(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const auto from_c = [&](const Eigen::Vector2d& p, Eigen::Index i) {
    return mpq_class(mpq_class(p[i]) - mpq_class(c[i]));
  };
  return sgn(mpq_class(from_c(a, 0) * from_c(b, 1) - from_c(a, 1) * from_c(b, 0)));
}

int expect_exact(const Eigen::Vector3d (&p)[4]) {
  const int sign = exact_sign(p[0], p[1], p[2], p[3]);
  EXPECT_EQ(orientation(p[0], p[1], p[2], p[3]), sign) << p[0] << p[1] << p[2] << p[3];
  EXPECT_EQ(OrientedPlane(p[0], p[1], p[2]).side_of(p[3]), sign) << p[0] << p[1] << p[2] << p[3];
  return sign;
}

// How often each sign came, for points that `coordinate` makes.
struct Signs {
  int negative = 0, zero = 0, positive = 0;
  void add(int sign) { ++(sign < 0 ? negative : sign > 0 ? positive : zero); }
};

template <class Coordinate>
Signs expect_exact(int times, const Coordinate& coordinate) {
  Signs signs;
  for (int i = 0; i < times; ++i) {
    Eigen::Vector3d p[4];
    for (Eigen::Vector3d& x : p) x = {coordinate(), coordinate(), coordinate()};
    const int sign = expect_exact(p);
    signs.add(sign);
    const Eigen::Vector2d q[] = {p[0].head<2>(), p[1].head<2>(), p[2].head<2>()};
    EXPECT_EQ(orientation(q[0], q[1], q[2]), exact_sign(q[0], q[1], q[2]));
  }
  return signs;
}

TEST(Orientation, TurnsAsItIsSaid) {
  const Eigen::Vector3d o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_EQ(orientation(o, x, y, z), -1);  // counter clockwise seen from z
  EXPECT_EQ(orientation(o, x, y, Eigen::Vector3d(0.5, 0.5, -1e-300)), 1);
  EXPECT_EQ(orientation(o, x, y, Eigen::Vector3d(7, -3, 0)), 0);
  EXPECT_EQ(orientation(o.head<2>(), x.head<2>(), y.head<2>()), 1);
}

TEST(Orientation, OfAnyPoints) {
  Random random(1);
  const Signs signs = expect_exact(samples(20'000), [&] { return random.uniform(-1, 1); });
  EXPECT_EQ(signs.zero, 0);
}

TEST(Orientation, OfPointsOnAGrid) {
  Random random(2);
  const Signs signs =
      expect_exact(samples(20'000), [&] { return 0.1 * static_cast<double>(random.below(3)); });
  EXPECT_GT(signs.zero, samples(3'000));
  EXPECT_GT(signs.negative, samples(1'500));
  EXPECT_GT(signs.positive, samples(1'500));
}

// A fourth point in the plane of three, as well as doubles can, and some last bits off.
TEST(Orientation, OfPointsNearlyInAPlane) {
  Random random(3);
  Signs signs;
  for (int i = 0; i < samples(20'000); ++i) {
    Eigen::Vector3d p[4];
    for (Eigen::Vector3d& x : p) {
      x = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    }
    const double u = random.uniform(-2, 2), v = random.uniform(-2, 2);
    p[3] = p[0] + u * (p[1] - p[0]) + v * (p[2] - p[0]);
    const auto axis = static_cast<Eigen::Index>(random.below(3));
    for (std::size_t k = random.below(4); k > 0; --k) p[3][axis] = std::nextafter(p[3][axis], 9);
    signs.add(expect_exact(p));
  }
  EXPECT_GT(signs.negative, samples(4'000));
  EXPECT_GT(signs.positive, samples(4'000));
}

TEST(Orientation, OfNumbersOfAnySize) {
  Random random(4);
  for (const int range : {60, 200, 339, 1020}) {
    expect_exact(samples(3'000), [&] {
      const int exponent = static_cast<int>(random.below(2 * static_cast<std::size_t>(range)));
      return std::ldexp(random.uniform(-1, 1), exponent - range);
    });
  }
}

// Whole numbers of few digits: a fourth point in the plane of three, and beside it.
TEST(Orientation, OfSmallWholeNumbers) {
  Random random(6);
  Signs signs;
  for (int i = 0; i < samples(20'000); ++i) {
    const double unit = std::ldexp(1.0, static_cast<int>(random.below(60)) - 30);
    const auto whole = [&] { return static_cast<double>(random.below(1 << 12)) - (1 << 11); };
    const auto times = [&] { return static_cast<double>(random.below(1 << 10)) - (1 << 9); };
    Eigen::Vector3d p[4];
    for (Eigen::Vector3d& x : p) x = Eigen::Vector3d(whole(), whole(), whole()) * unit;
    p[3] = p[0] + times() * (p[1] - p[0]) + times() * (p[2] - p[0]);
    p[3][0] += unit * (static_cast<double>(random.below(3)) - 1);
    signs.add(expect_exact(p));
  }
  EXPECT_GT(signs.zero, samples(4'000));
  EXPECT_GT(signs.negative, samples(4'000));
}

// Products that are less than the least double, and points that are themselves hardly more.
TEST(Orientation, OfTheLeastNumbers) {
  Random random(5);
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  const Signs signs = expect_exact(
      samples(5'000), [&] { return kLeast * (static_cast<double>(random.below(5)) - 2); });
  EXPECT_GT(signs.negative, samples(800));
  EXPECT_GT(signs.positive, samples(800));
  expect_exact(samples(5'000), [&] {
    return random.below(2) == 0 ? kLeast * static_cast<double>(random.below(9))
                                : std::ldexp(1.0, static_cast<int>(random.below(30)));
  });
}

template <class Number>
TriangleCorners corners(const Number& number) {
  TriangleCorners t;
  for (Eigen::Vector3d& x : t) x = {number(), number(), number()};
  return t;
}

// Both ways round, and whichever corner comes first.
bool expect_exact(const TriangleCorners& a, const TriangleCorners& b) {
  const bool meet = polygons_meet(exact_triangle(a), exact_triangle(b));
  TriangleCorners turned = a;
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_EQ(triangles_meet(turned, b), meet);
    EXPECT_EQ(triangles_meet(b, turned), meet);
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    std::swap(turned[1], turned[2]);
  }
  return meet;
}

// Many touch in a point or along an edge, lie in one plane, or are degenerate.
TEST(TrianglesMeet, OnAGrid) {
  Random random(1);
  int meet = 0;
  for (const std::size_t size : {2u, 3u, 4u, 6u}) {
    const auto number = [&] { return 0.1 * static_cast<double>(random.below(size)); };
    for (int i = 0; i < samples(4'000) && !::testing::Test::HasFailure(); ++i) {
      meet += expect_exact(corners(number), corners(number)) ? 1 : 0;
    }
  }
  EXPECT_GT(meet, samples(2'000));
  EXPECT_LT(meet, samples(14'000));
}

TEST(TrianglesMeet, InOnePlane) {
  Random random(2);
  int meet = 0;
  for (int i = 0; i < samples(6'000) && !::testing::Test::HasFailure(); ++i) {
    const auto axis = static_cast<Eigen::Index>(random.below(3));
    const auto number = [&] { return 0.1 * static_cast<double>(random.below(5)); };
    TriangleCorners a = corners(number), b = corners(number);
    for (TriangleCorners* t : {&a, &b}) {
      // On a coordinate's plane, or on a slanted one.
      for (Eigen::Vector3d& x : *t) {
        x[axis] = i % 2 == 0 ? 0.3 : x[(axis + 1) % 3] - 2 * x[(axis + 2) % 3];
      }
    }
    meet += expect_exact(a, b) ? 1 : 0;
  }
  EXPECT_GT(meet, samples(500));
  EXPECT_LT(meet, samples(5'750));
}

TEST(TrianglesMeet, WhereverTheyAre) {
  Random random(3);
  const auto number = [&] { return random.uniform(-1, 1); };
  int meet = 0;
  for (int i = 0; i < samples(4'000) && !::testing::Test::HasFailure(); ++i) {
    meet += expect_exact(corners(number), corners(number)) ? 1 : 0;
  }
  EXPECT_GT(meet, samples(250));
  EXPECT_LT(meet, samples(3'750));
}

// A corner of one brought to a face, an edge or a corner of the other, as near as doubles can.
TEST(TrianglesMeet, WhereTheLastBitDecides) {
  Random random(4);
  const auto number = [&] { return random.uniform(-1, 1); };
  int meet = 0;
  for (int i = 0; i < samples(6'000) && !::testing::Test::HasFailure(); ++i) {
    const TriangleCorners a = corners(number);
    TriangleCorners b = corners(number);
    const double u = i % 3 == 0 ? 0 : random.uniform(0, 1);
    const double v = i % 3 == 2 ? random.uniform(0, 1 - u) : 0;
    const Eigen::Vector3d shift = a[0] + u * (a[1] - a[0]) + v * (a[2] - a[0]) - b[0];
    for (Eigen::Vector3d& x : b) x += shift;
    const auto axis = static_cast<Eigen::Index>(random.below(3));
    const double to = random.below(2) == 0 ? 9 : -9;
    for (std::size_t k = random.below(3); k > 0; --k) b[0][axis] = std::nextafter(b[0][axis], to);
    meet += expect_exact(a, b) ? 1 : 0;
  }
  EXPECT_GT(meet, samples(1'000));
  EXPECT_LT(meet, samples(5'750));
}

}  // namespace
}  // namespace ist::test
