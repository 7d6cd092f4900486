#include "advise/closing_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ist/models/models.h"
#include "query/triangles/triangle_tree.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// Two meshes as bodies.
struct Pair {
  Pair(const TriangleMesh& a, const TriangleMesh& b)
      : fixed(triangle_tree(a, 1)), moving(triangle_tree(b, 1)), exact(fixed, moving) {}

  [[nodiscard]] AxisDirection shortest() const { return shortest_open_direction(fixed, moving); }
  [[nodiscard]] double distance(const Eigen::Isometry3d& pose) {
    return exact.distance(pose, 0).distance.upper;
  }

  SphereTree fixed, moving;
  Query exact;
};

constexpr double kAccuracy = 2e-6;
const TriangleMesh kCube = box({0, 0, 0}, {1, 1, 1});

// A box of 0.8 x 0.8 x 1 above the cube's middle, from z on.
TriangleMesh above(double z) { return box({0.1, 0.1, z}, {0.9, 0.9, z + 1}); }

void expect_is_touch(Pair& pair, const ClosingPath& path) {
  EXPECT_LE(pair.distance(path.pose(path.first_contact)), kAccuracy);
  EXPECT_EQ(pair.distance(path.pose(path.first_contact - kAccuracy)), 0);
  EXPECT_GT(path.begin, path.first_contact);
  EXPECT_LE(path.end, path.first_contact);
}

TEST(ClosingPath, OpensWhatTouches) {
  Pair pair(kCube, above(0.7));
  const AxisDirection way = pair.shortest();
  EXPECT_EQ(way.axis, 2);
  EXPECT_EQ(way.sign, +1);
  const auto path = find_closing_path(pair.exact, way);
  ASSERT_TRUE(path);
  expect_is_touch(pair, *path);
  EXPECT_NEAR(path->first_contact, 0.3, kAccuracy);
  EXPECT_NEAR(path->begin, 0.3 + 0.02, kAccuracy);
  EXPECT_EQ(path->end, 0);

  const auto poses = path->poses(5);
  ASSERT_EQ(poses.size(), 5u);
  EXPECT_EQ(path->poses().size(), kClosingPoses);
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
  const auto path = find_closing_path(pair.exact, pair.shortest());
  ASSERT_TRUE(path);
  expect_is_touch(pair, *path);
  EXPECT_NEAR(path->first_contact, -0.5, kAccuracy);
  EXPECT_NEAR(path->end, -0.5 - 0.01 * std::sqrt(2 * 0.64 + 1), kAccuracy);
}

// Each of the six ways is found, and may be named.
TEST(ClosingPath, AllWays) {
  for (const int axis : {0, 1, 2}) {
    for (const int sign : {+1, -1}) {
      const Eigen::Vector3d shift = 0.75 * sign * Eigen::Vector3d::Unit(axis);
      Pair pair(kCube, moved(box({0.05, 0.05, 0.05}, {0.95, 0.95, 0.95}), shift));
      const AxisDirection way = pair.shortest();
      EXPECT_EQ(way.axis, axis);
      EXPECT_EQ(way.sign, sign);
      const auto path = find_closing_path(pair.exact, way);
      ASSERT_TRUE(path);
      EXPECT_NEAR(path->first_contact, 0.2, kAccuracy);
      const auto back = find_closing_path(pair.exact, {axis, -sign});
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->first_contact, 0.95 + 0.75, kAccuracy);
    }
  }
}

TEST(ClosingPath, BodiesThatGoPastEachOther) {
  Pair pair(kCube, moved(kCube, {1.5, 1.5, 0}));
  for (const int axis : {0, 1, 2}) {
    EXPECT_FALSE(find_closing_path(pair.exact, {axis, +1})) << axis;
    EXPECT_FALSE(find_closing_path(pair.exact, {axis, -1})) << axis;
  }
  // Side by side they touch one way, and not the other.
  Pair beside(kCube, moved(kCube, {1.5, 0.5, 0}));
  EXPECT_TRUE(find_closing_path(beside.exact, {0, +1}));
  EXPECT_FALSE(find_closing_path(beside.exact, {0, -1}));
  EXPECT_FALSE(find_closing_path(beside.exact, {1, +1}));
}

// A body inside the other is not free, though nothing touches.
TEST(ClosingPath, OpensABodyInsideTheOther) {
  Pair pair(icosphere(2, 2), icosphere(2, 0.5));
  const auto path = find_closing_path(pair.exact, {2, -1});
  ASSERT_TRUE(path);
  expect_is_touch(pair, *path);
  EXPECT_GT(path->first_contact, 2.2);
  EXPECT_LE(path->first_contact, 2.5 + 1e-6);
  EXPECT_EQ(path->end, 0);
}

TEST(ClosingPath, Jaws) {
  Pair pair(make_jaw(Jaw::kUpper, 1), make_jaw(Jaw::kLower, 1));
  const AxisDirection way = pair.shortest();
  EXPECT_EQ(way.axis, 2);
  EXPECT_EQ(way.sign, -1);
  const auto path = find_closing_path(pair.exact, way);
  ASSERT_TRUE(path);
  EXPECT_GT(path->first_contact, 0.5);  // they are made too close by about 1 mm
  EXPECT_LT(path->first_contact, 2);
}

}  // namespace
}  // namespace ist::test
