#include "ist/mesh/triangles_meet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "query/query_cases.h"
#include "support/effort.h"
#include "support/exact_polygon.h"

namespace ist::test {
namespace {

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

// Many touch in a point or along an edge, lie in one plane, or have no area.
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
