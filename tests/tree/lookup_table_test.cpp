#include "ist/tree/lookup_table.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>
#include <tuple>
#include <vector>

#include "ist/tree/implicit_ball.h"
#include "support/exact.h"

namespace ist {
namespace {

using test::ExactPoint;

// The corners of the children's cubes, in units of a sixth of the node's half edge.
std::vector<ExactPoint> corners(unsigned mask) {
  std::vector<ExactPoint> corners;
  for (int octant = 0; octant < 8; ++octant) {
    if ((mask >> octant & 1) == 0) continue;
    for (int corner = 0; corner < 8; ++corner) {
      ExactPoint p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool upper = (octant >> axis & 1) != 0, end = (corner >> axis & 1) != 0;
        p[axis] = (upper ? 0 : -6) + (end ? 6 : 0);
      }
      corners.push_back(p);
    }
  }
  return corners;
}

TEST(LookupTable, HoldsTheSmallestBallOfEachMask) {
  for (unsigned mask = 1; mask < 256; ++mask) {
    const TableBall& ball = kLookupTable[mask];
    const test::ExactBall smallest = test::smallest_ball(corners(mask));
    EXPECT_EQ(ball.x, smallest.centre[0]) << mask;
    EXPECT_EQ(ball.y, smallest.centre[1]) << mask;
    EXPECT_EQ(ball.z, smallest.centre[2]) << mask;
    EXPECT_EQ(ball.radius_squared, smallest.radius_squared) << mask;
  }
}

TEST(LookupTable, HasFewDistinctBallsAndRadii) {
  std::set<std::tuple<int, int, int, int>> balls;
  std::set<int> radii;
  int smaller = 0;
  for (unsigned mask = 1; mask < 256; ++mask) {
    const TableBall& ball = kLookupTable[mask];
    balls.insert({ball.x, ball.y, ball.z, ball.radius_squared});
    radii.insert(ball.radius_squared);
    smaller += ball.radius_squared < 108;
    EXPECT_TRUE(std::popcount(mask) < 5 || ball.radius_squared == 108) << mask;
  }
  EXPECT_EQ(balls.size(), 35u);
  EXPECT_EQ(radii, (std::set<int>{27, 54, 81, 96, 108}));
  EXPECT_EQ(smaller, 78);
}

TEST(LookupTable, ANodeWithoutChildrenIsAPoint) { EXPECT_EQ(kLookupTable[0], TableBall{}); }

TEST(TableRadii, AreTheSquareRootsRoundedUp) {
  for (std::size_t code = 0; code < kTableRadii.size(); ++code) {
    const mpq_class expected(kTableSquares[code], 36);
    const mpq_class radius(kTableRadii[code]);
    const mpq_class below(std::nextafter(kTableRadii[code], 0.0));
    EXPECT_GE(radius * radius, expected) << code;
    EXPECT_LT(below * below, expected) << code;
  }
  EXPECT_EQ(kTableRadii[kCircumsphereCode], kSqrt3);
}

}  // namespace
}  // namespace ist
