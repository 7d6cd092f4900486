#include "ist/tree/node_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ist/tree/enclosing_ball.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/random.h"

namespace ist {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

// Holds all points up to the rounding of a distance, and is at most `tolerance` too large.
void expect_a_small_ball(const Points& points, double tolerance) {
  const Ball ball = enclosing_ball(points, tolerance);
  ASSERT_TRUE(ball.centre.allFinite());
  std::vector<test::ExactPoint> exact_points;
  mpq_class farthest = 0;
  const test::ExactPoint centre = test::exact(ball.centre);
  double magnitude = 0;
  for (const Vector3d& p : points) {
    exact_points.push_back(test::exact(p));
    farthest = std::max(farthest, test::square(exact_points.back() - centre));
    magnitude = std::max(magnitude, p.norm());
  }
  EXPECT_GE(ball.radius * (1 + 1e-15) + 1e-300, std::sqrt(farthest.get_d()));
  const double smallest = std::sqrt(test::smallest_ball(exact_points).radius_squared.get_d());
  // Rounding of the coordinates themselves is not the tolerance's business.
  EXPECT_LE(ball.radius, smallest * (1 + tolerance) * (1 + 1e-14) + 1e-15 * magnitude);
}

void expect_small_balls(const Points& points) {
  for (const double tolerance : {0.008, 1e-6}) expect_a_small_ball(points, tolerance);
}

TEST(EnclosingBall, OfRandomPoints) {
  test::Random random(1);
  for (int round = 0; round < test::samples(200); ++round) {
    Points points(1 + random.below(40));
    for (Vector3d& p : points) p = random.point(-1, 1);
    expect_small_balls(points);
  }
}

TEST(EnclosingBall, OfPointsInAPlane) {
  test::Random random(2);
  for (int round = 0; round < test::samples(60); ++round) {
    const Vector3d u = random.direction(), v = random.direction(), at = random.point(-1, 1);
    Points points(1 + random.below(40));
    for (Vector3d& p : points) p = at + random.uniform(-1, 1) * u + random.uniform(-1, 1) * v;
    expect_small_balls(points);
  }
}

TEST(EnclosingBall, OfPointsOnALine) {
  test::Random random(3);
  for (int round = 0; round < test::samples(60); ++round) {
    const Vector3d u = random.direction(), at = random.point(-1, 1);
    Points points(1 + random.below(40));
    for (Vector3d& p : points) p = at + random.uniform(-1, 1) * u;
    expect_small_balls(points);
  }
}

TEST(EnclosingBall, OfPointsOnACircleOrASphere) {
  test::Random random(4);
  for (int round = 0; round < test::samples(60); ++round) {
    Points circle(2 + random.below(39)), sphere(circle.size());
    const Vector3d at = random.point(-1, 1);
    for (std::size_t i = 0; i < circle.size(); ++i) {
      Vector3d direction = random.direction();
      sphere[i] = at + direction;
      direction[2] = 0;
      circle[i] = at + direction.normalized();
    }
    expect_small_balls(circle);
    expect_small_balls(sphere);
  }
}

TEST(EnclosingBall, OfPointsOnAGridAndDuplicates) {
  test::Random random(5);
  for (int round = 0; round < test::samples(200); ++round) {  // many lie on one sphere exactly
    Points points(1 + random.below(40));
    for (Vector3d& p : points) p = random.point_on_grid(-1, 2, 1);
    expect_small_balls(points);
  }
  const Vector3d p(1, 2, 3);
  for (const std::size_t count : {1u, 2u, 40u}) {
    const Ball ball = enclosing_ball(Points(count, p), 0.008);
    EXPECT_EQ(ball.centre, p);
    EXPECT_EQ(ball.radius, 0.0);
  }
}

TEST(EnclosingBall, OfNearlyEqualPointsAndNeedles) {
  test::Random random(6);
  for (int round = 0; round < test::samples(100); ++round) {
    const Vector3d at = random.point(-1, 1), u = random.direction();
    Points cluster(2 + random.below(20)), needle(cluster.size());
    for (std::size_t i = 0; i < cluster.size(); ++i) {
      cluster[i] = at + 1e-9 * random.point(-1, 1);
      needle[i] = at + random.uniform(-1, 1) * u + 1e-12 * random.point(-1, 1);
    }
    expect_small_balls(cluster);
    expect_small_balls(needle);
  }
}

TEST(EnclosingBall, FarFromTheOriginAndAtAnyScale) {
  test::Random random(7);
  for (int round = 0; round < test::samples(60); ++round) {
    const double scale = std::ldexp(1.0, static_cast<int>(random.below(80)) - 40);
    Points points(1 + random.below(30)), far(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d p = random.point(-1, 1);
      points[i] = scale * p;
      far[i] = Vector3d(1e6, -1e6, 1e6) + p;
    }
    expect_small_balls(points);
    expect_small_balls(far);
  }
}

// The smallest ball round balls, taken in one by one as long as one is outside. Points of the balls
// on the side away from its centre show that no ball that holds them is smaller.
void expect_a_small_ball_round(const std::vector<Ball>& balls) {
  Support<Ball> support{{balls[0]}, 1, balls[0].centre, balls[0].radius};
  const auto reach = [&](const Ball& ball) {
    return (ball.centre - support.centre).norm() + ball.radius;
  };
  const auto outermost = [&] {
    return *std::max_element(balls.begin(), balls.end(),
                             [&](const Ball& a, const Ball& b) { return reach(a) < reach(b); });
  };
  int rounds = 0;
  while (reach(outermost()) > support.size * (1 + 1e-9)) {
    const double before = support.size;
    ASSERT_TRUE(take_in(support, outermost()));
    ASSERT_GT(support.size, before);
    ASSERT_LT(++rounds, 100);
  }
  ASSERT_GE(support.count, 1);
  ASSERT_LE(support.count, 4);
  std::vector<test::ExactPoint> points;
  for (int i = 0; i < support.count; ++i) {
    const Ball& ball = support.sites[i];
    const Vector3d out = ball.centre - support.centre;
    EXPECT_NEAR(reach(ball), support.size, 1e-9 * support.size);
    if (support.count == 1) return;
    points.push_back(test::exact(ball.centre + out * (ball.radius / out.norm())));
  }
  const double least = std::sqrt(test::smallest_ball(points).radius_squared.get_d());
  EXPECT_LE(support.size, least * (1 + 1e-6));
}

TEST(SupportOfBalls, IsThatOfTheSmallestBallRoundThem) {
  test::Random random(8);
  for (int round = 0; round < test::samples(300); ++round) {
    std::vector<Ball> balls(1 + random.below(30));
    const double largest = random.uniform(0, 2);
    for (Ball& ball : balls) ball = {random.point(-1, 1), random.uniform(0, largest)};
    ASSERT_NO_FATAL_FAILURE(expect_a_small_ball_round(balls));
  }
}

TEST(SupportOfBalls, OfOneThatHoldsTheOthersIsThatOne) {
  const Ball small{{0.5, 0, 0}, 0.25}, large{{0, 0, 0}, 2};
  Support<Ball> support{{small}, 1, small.centre, small.radius};
  ASSERT_TRUE(take_in(support, large));
  EXPECT_EQ(support.count, 1);
  EXPECT_EQ(support.centre, large.centre);
  EXPECT_EQ(support.size, 2);
}

// Equal balls in a row and in a plane. The ball round them is the ball round their centres,
// enlarged by their radius.
TEST(SupportOfBalls, OfEqualBallsInARowOrInAPlane) {
  test::Random random(9);
  for (int round = 0; round < test::samples(100); ++round) {
    const Vector3d u = random.direction(), v = random.direction();
    std::vector<Ball> row(2 + random.below(8)), plane(row.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = {random.uniform(-1, 1) * u, 0.5};
      plane[i] = {random.uniform(-1, 1) * u + random.uniform(-1, 1) * v, 0.5};
    }
    ASSERT_NO_FATAL_FAILURE(expect_a_small_ball_round(row));
    ASSERT_NO_FATAL_FAILURE(expect_a_small_ball_round(plane));
  }
}

// In a parent's cube of edge 2 round the origin; a child's has edge 1.
constexpr double kUnit = 0x1p-15, kSlabUnit = 0x1p-8;

Payload payload(std::vector<Vector3d> points, const Vector3d& area = {0, 0, 0}) {
  return {std::move(points), area, 0x1p-48};
}

PackedBall ball_of(const Payload& payload) { return pack_ball(payload, {0, 0, 0}, 2); }

TEST(PackBall, OfAPointOnItsLatticeIsOneUnit) {
  EXPECT_EQ(ball_of(payload({{0, 0, 0}})), (PackedBall{0, 0, 0, 1}));
  EXPECT_EQ(ball_of(payload({{-1, -1, -1}})), (PackedBall{-32768, -32768, -32768, 1}));
  EXPECT_EQ(ball_of(payload({{0.5, -0.25, kUnit}})), (PackedBall{16384, -8192, 1, 1}));
}

TEST(PackBall, RoundsTheCentreToTheNearestUnitAndTheRadiusUp) {
  EXPECT_EQ(ball_of(payload({{3.4 * kUnit, 3.6 * kUnit, -3.6 * kUnit}})),
            (PackedBall{3, 4, -4, 1}));
  EXPECT_EQ(ball_of(payload({{-0.5, 0, 0}, {0.5, 0, 0}})), (PackedBall{0, 0, 0, 16385}));
}

// The far faces of the parent's cube are one unit beyond the range of a block.
TEST(PackBall, HoldsWhatLiesBeyondTheLastCentre) {
  EXPECT_EQ(ball_of(payload({{1, 1, 1}})), (PackedBall{32767, 32767, 32767, 2}));
  EXPECT_EQ(ball_of(payload({{1 + 2 * kUnit, 0, 0}})), (PackedBall{32767, 0, 0, 4}));
  EXPECT_EQ(ball_of(payload({{1, -1, 0}, {1, 0, 0}})), (PackedBall{32767, -16384, 0, 16385}));
}

TEST(PackBall, HasItsCentreInTheParentsCube) {
  const PackedBall ball = pack_ball(payload({{3, 4, 5}}), {3.5, 3.5, 4.5}, 2);
  EXPECT_EQ(ball, (PackedBall{-16384, 16384, 16384, 1}));
  EXPECT_EQ(centre_of(ball, {3.5, 3.5, 4.5}, 2), Vector3d(3, 4, 5));
}

TEST(PackSlab, OfAPlaneIsOneUnit) {
  const Payload square = payload({{0, 0, 0.25}, {1, 0, 0.25}, {1, 1, 0.25}, {0, 1, 0.25}});
  const PackedSlab slab = pack_slab(square, {0.5, 0.5, 0.25}, 1);
  EXPECT_EQ(std::abs(slab.nz), 126);
  EXPECT_EQ(slab, (PackedSlab{0, 0, slab.nz, 0, 1}));
}

// A normal is rounded by up to half a degree: the slab of a large plane across is a little thicker.
TEST(PackSlab, OfAPlaneAcrossIsAFewUnits) {
  test::Random random(1);
  for (int i = 0; i < test::samples(100); ++i) {
    const Vector3d u = 0.3 * random.direction(), v = 0.3 * random.direction();
    const PackedSlab slab = pack_slab(payload({-u, u, -v, v}), {0, 0, 0}, 1);
    EXPECT_LE(slab.half, 3);
  }
}

// Many points on four edges, and one off them: it spreads little, and yet it makes a thick slab.
TEST(PackSlab, TakesTheThinnerOfTwoAxes) {
  std::vector<Vector3d> points{{0, 0.2, 0}};
  for (int i = 0; i < 80; ++i) {
    points.emplace_back((i & 1) != 0 ? 0.3 : -0.3, 0, (i & 2) != 0 ? 0.05 : -0.05);
  }
  const Vector3d centre(0, 0.05, 0);
  const PackedSlab by_spread = pack_slab(payload(points), centre, 1);
  EXPECT_EQ(std::abs(by_spread.ny), 126);
  EXPECT_NEAR(by_spread.half * kSlabUnit, 0.1, 0.01);
  const PackedSlab by_area = pack_slab(payload(points, {0, 0, 1e-9}), centre, 1);
  EXPECT_EQ(by_area.nz, 126);
  EXPECT_NEAR(by_area.half * kSlabUnit, 0.05, 0.01);
  EXPECT_EQ(pack_slab(payload(points, {2, 0, 0}), centre, 1), by_spread);
}

TEST(PackSlab, HasItsOffsetFromTheBallsCentre) {
  const Payload square = payload({{0, 0, 0.25}, {1, 0, 0.25}, {1, 1, 0.25}, {0, 1, 0.25}});
  const PackedSlab slab = pack_slab(square, {0.5, 0.5, 0}, 1);
  EXPECT_EQ(slab.offset * slab.nz, 63 * 126);  // a quarter of an edge along a normal of 126/128
  EXPECT_LE(slab.half, 2);
}

TEST(PackSlab, OfAPointIsOneUnitAcrossSomeAxis) {
  const PackedSlab slab = pack_slab(payload({{0.1, 0.2, 0.3}}), {0.1, 0.2, 0.3}, 1);
  EXPECT_EQ(slab.nx * slab.nx + slab.ny * slab.ny + slab.nz * slab.nz, 126 * 126);
  EXPECT_EQ(slab.half, 1);
}

TEST(PackSlab, HoldsEverythingWhereItsNumbersDoNotReach) {
  const PackedSlab all{0, 0, 0, 0, 255};
  EXPECT_EQ(pack_slab(payload({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), {0, 0, 2}, 1), all);
}

}  // namespace
}  // namespace ist
