#include "advise/closing_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ist/models/models.h"
#include "query/exact/exact_tree.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// Two meshes as bodies.
struct Pair {
  Pair(const TriangleMesh& a, const TriangleMesh& b, double cells = 10)
      : fixed(exact_tree(a, cells)), moving(exact_tree(b, cells)), bodies(fixed, moving) {}

  SphereTree fixed, moving;
  ExactBodies bodies;
};

const TriangleMesh kCube = box({0, 0, 0}, {1, 1, 1});

// A box of 0.8 x 0.8 x 1 above the cube's middle, from z on.
TriangleMesh above(double z) { return box({0.1, 0.1, z}, {0.9, 0.9, z + 1}); }

AxisDirection shortest_open_direction(ExactBodies& bodies) {
  return ist::shortest_open_direction(bodies.fixed_box(), bodies.moving_box());
}

void expect_is_touch(ExactBodies& bodies, const ClosingPath& path) {
  EXPECT_EQ(bodies.distance(path.pose(path.first_contact), 0).upper, 0);
  EXPECT_TRUE(bodies.free(path.pose(path.first_contact + path.accuracy)));
  EXPECT_GT(path.begin, path.first_contact);
  EXPECT_LE(path.end, path.first_contact);
}

TEST(ClosingPath, OpensWhatTouches) {
  Pair pair(kCube, above(0.7));
  const AxisDirection way = shortest_open_direction(pair.bodies);
  EXPECT_EQ(way.axis, 2);
  EXPECT_EQ(way.sign, +1);
  const auto path = find_closing_path(pair.bodies, way);
  ASSERT_TRUE(path);
  expect_is_touch(pair.bodies, *path);
  EXPECT_NEAR(path->first_contact, 0.3, path->accuracy);
  EXPECT_NEAR(path->begin, 0.3 + 0.02, 2 * path->accuracy);
  EXPECT_EQ(path->end, 0);
  EXPECT_LT(path->accuracy, 2e-6);

  const auto poses = path->poses(12);
  ASSERT_EQ(poses.size(), 12u);
  EXPECT_EQ(poses.front().translation()[2], path->begin);
  EXPECT_EQ(poses.back().translation()[2], path->end);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_LT(poses[i].translation()[2], poses[i - 1].translation()[2]);
    EXPECT_TRUE(poses[i].linear().isIdentity(0));
    EXPECT_EQ(poses[i].translation()[0], 0);
  }
}

TEST(ClosingPath, ClosesWhatIsFree) {
  Pair pair(kCube, above(1.5));
  const auto path = find_closing_path(pair.bodies, shortest_open_direction(pair.bodies));
  ASSERT_TRUE(path);
  expect_is_touch(pair.bodies, *path);
  EXPECT_NEAR(path->first_contact, -0.5, path->accuracy);
  EXPECT_NEAR(path->end, -0.5 - 0.01 * std::sqrt(2 * 0.64 + 1), 2 * path->accuracy);
}

// Each of the six ways is found, and may be named.
TEST(ClosingPath, AllWays) {
  for (const int axis : {0, 1, 2}) {
    for (const int sign : {+1, -1}) {
      const Eigen::Vector3d shift = 0.75 * AxisDirection{axis, sign}.vector();
      Pair pair(kCube, moved(box({0.05, 0.05, 0.05}, {0.95, 0.95, 0.95}), shift));
      const AxisDirection way = shortest_open_direction(pair.bodies);
      EXPECT_EQ(way.axis, axis);
      EXPECT_EQ(way.sign, sign);
      const auto path = find_closing_path(pair.bodies, way);
      ASSERT_TRUE(path);
      EXPECT_NEAR(path->first_contact, 0.2, path->accuracy);
      const auto back = find_closing_path(pair.bodies, {axis, -sign});
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->first_contact, 0.95 + 0.75, back->accuracy);
    }
  }
}

TEST(ClosingPath, BodiesThatGoPastEachOther) {
  Pair pair(kCube, moved(kCube, {1.5, 1.5, 0}));
  for (const int axis : {0, 1, 2}) {
    EXPECT_FALSE(find_closing_path(pair.bodies, {axis, +1})) << axis;
    EXPECT_FALSE(find_closing_path(pair.bodies, {axis, -1})) << axis;
  }
  // Side by side they touch one way, and not the other.
  Pair beside(kCube, moved(kCube, {1.5, 0.5, 0}));
  EXPECT_TRUE(find_closing_path(beside.bodies, {0, +1}));
  EXPECT_FALSE(find_closing_path(beside.bodies, {0, -1}));
  EXPECT_FALSE(find_closing_path(beside.bodies, {1, +1}));
}

// What is inside is not free, though nothing touches.
TEST(ClosingPath, OpensWhatIsInside) {
  Pair pair(icosphere(2, 2), icosphere(2, 0.5));
  const auto path = find_closing_path(pair.bodies, {2, -1});
  ASSERT_TRUE(path);
  expect_is_touch(pair.bodies, *path);
  EXPECT_GT(path->first_contact, 2.2);
  EXPECT_LE(path->first_contact, 2.5);
  EXPECT_EQ(path->end, 0);
}

// A hook, and a block in its mouth: the nearest opening counts, not that from outside.
TEST(ClosingPath, OpensNoFartherThanItMust) {
  const TriangleMesh hook =
      joined(joined(kCube, box({0, 0, 3}, {1, 1, 4})), box({-1, 0, 0}, {-0.1, 1, 4}));
  Pair pair(hook, above(0.9));
  const auto path = find_closing_path(pair.bodies, {2, +1});
  ASSERT_TRUE(path);
  EXPECT_NEAR(path->first_contact, 0.1, path->accuracy);
}

TEST(ClosingPath, Jaws) {
  Pair pair(make_jaw(Jaw::kUpper, 1), make_jaw(Jaw::kLower, 1), 100);
  const AxisDirection way = shortest_open_direction(pair.bodies);
  EXPECT_EQ(way.axis, 2);
  EXPECT_EQ(way.sign, -1);
  const auto path = find_closing_path(pair.bodies, way);
  ASSERT_TRUE(path);
  expect_is_touch(pair.bodies, *path);
  EXPECT_GT(path->first_contact, 0.5);  // they are made too close by about 1 mm
  EXPECT_LT(path->first_contact, 2);
}

// Inclined by 20 degrees, turned by 3, and where they end the bodies touch.
TEST(ClosingPath, WaysBeside) {
  constexpr double kDegrees = 57.29577951308232;
  Pair pair(kCube, above(0.7));
  const auto path = find_closing_path(pair.bodies, {2, +1});
  ASSERT_TRUE(path);
  const std::vector<ClosingPath> beside = paths_beside(pair.bodies, *path);
  ASSERT_EQ(beside.size(), 6u);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ClosingPath& way : beside) {
    expect_is_touch(pair.bodies, way);
    EXPECT_EQ(way.end, way.first_contact);
    EXPECT_TRUE(pair.bodies.free(way.pose(way.begin)));
    EXPECT_NEAR(kDegrees * std::acos(way.open_direction.dot(path->open_direction)), 20, 0.1);
    EXPECT_NEAR(kDegrees * Eigen::AngleAxisd(way.turn).angle(), 3, 0.01);
    const Eigen::Vector3d& middle = pair.bodies.moving_box().center();
    EXPECT_LT((way.pose(0) * middle - middle).norm(), 1e-12);
    sum += way.open_direction - way.open_direction.dot(path->open_direction) * path->open_direction;
  }
  EXPECT_LT(sum.norm(), 1e-12);  // to all sides
}

}  // namespace
}  // namespace ist::test
