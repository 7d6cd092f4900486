#include "ist/tree/enclosing_ball.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/exact.h"
#include "support/seeded.h"

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
  test::Seeded seeded(1);
  for (int round = 0; round < 200; ++round) {
    Points points(1 + seeded.below(40));
    for (Vector3d& p : points) p = seeded.point(-1, 1);
    expect_small_balls(points);
  }
}

TEST(EnclosingBall, OfPointsInAPlane) {
  test::Seeded seeded(2);
  for (int round = 0; round < 60; ++round) {
    const Vector3d u = seeded.direction(), v = seeded.direction(), at = seeded.point(-1, 1);
    Points points(1 + seeded.below(40));
    for (Vector3d& p : points) p = at + seeded.between(-1, 1) * u + seeded.between(-1, 1) * v;
    expect_small_balls(points);
  }
}

TEST(EnclosingBall, OfPointsOnALine) {
  test::Seeded seeded(3);
  for (int round = 0; round < 60; ++round) {
    const Vector3d u = seeded.direction(), at = seeded.point(-1, 1);
    Points points(1 + seeded.below(40));
    for (Vector3d& p : points) p = at + seeded.between(-1, 1) * u;
    expect_small_balls(points);
  }
}

TEST(EnclosingBall, OfPointsOnACircleOrASphere) {
  test::Seeded seeded(4);
  for (int round = 0; round < 60; ++round) {
    Points circle(2 + seeded.below(39)), sphere(circle.size());
    const Vector3d at = seeded.point(-1, 1);
    for (std::size_t i = 0; i < circle.size(); ++i) {
      Vector3d direction = seeded.direction();
      sphere[i] = at + direction;
      direction[2] = 0;
      circle[i] = at + direction.normalized();
    }
    expect_small_balls(circle);
    expect_small_balls(sphere);
  }
}

TEST(EnclosingBall, OfPointsOnAGridAndDuplicates) {
  test::Seeded seeded(5);
  for (int round = 0; round < 200; ++round) {  // many lie on one sphere exactly
    Points points(1 + seeded.below(40));
    for (Vector3d& p : points) p = seeded.point_on_grid(-1, 2, 1);
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
  test::Seeded seeded(6);
  for (int round = 0; round < 100; ++round) {
    const Vector3d at = seeded.point(-1, 1), u = seeded.direction();
    Points cluster(2 + seeded.below(20)), needle(cluster.size());
    for (std::size_t i = 0; i < cluster.size(); ++i) {
      cluster[i] = at + 1e-9 * seeded.point(-1, 1);
      needle[i] = at + seeded.between(-1, 1) * u + 1e-12 * seeded.point(-1, 1);
    }
    expect_small_balls(cluster);
    expect_small_balls(needle);
  }
}

TEST(EnclosingBall, FarFromTheOriginAndAtAnyScale) {
  test::Seeded seeded(7);
  for (int round = 0; round < 60; ++round) {
    const double scale = std::ldexp(1.0, static_cast<int>(seeded.below(80)) - 40);
    Points points(1 + seeded.below(30)), far(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d p = seeded.point(-1, 1);
      points[i] = scale * p;
      far[i] = Vector3d(1e6, -1e6, 1e6) + p;
    }
    expect_small_balls(points);
    expect_small_balls(far);
  }
}

}  // namespace
}  // namespace ist
