#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ist/query/inside.h"
#include "ist/query/query.h"
#include "ist/tree/tree_parts.h"
#include "query/triangles/mesh_distance.h"
#include "query/triangles/triangle_tree.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// Doubles that are moved in another order.
constexpr double kRounding = 1e-6;

TEST(QueryDistance, HoldsTheDistance) {
  int touching = 0, apart = 0;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{40}) && !::testing::Test::HasFailure();
       ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const double cells_a = random.uniform(1, 12), cells_b = random.uniform(1, 12);
    const SphereTree fixed = triangle_tree(a, cells_a), moving = triangle_tree(b, cells_b);
    const SphereTree plain_fixed = tree_of(a, cells_a), plain_moving = tree_of(b, cells_b);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Matrix3d rotation = random.rotation();
      const Eigen::Vector3d to = a.vertices[random.below(a.vertices.size())] -
                                 rotation * b.vertices[random.below(b.vertices.size())];
      const Eigen::Isometry3d pose =
          pose_of(rotation, to + random.uniform(0, 1.5) * random.direction());
      const double distance =
          mesh_distance(parts_of(fixed).triangles->mesh, parts_of(moving).triangles->mesh, pose);
      (distance > 0 ? apart : touching) += 1;
      for (const SpherePolicy policy : kSpherePolicies) {
        QueryOptions options;
        options.policy = policy;
        Query exact(fixed, moving, options), plain(plain_fixed, plain_moving, options);
        for (const double tolerance : {0.0, 1e-3, 0.1, 10.0}) {
          const DistanceResult of_exact = exact.distance(pose, tolerance);
          EXPECT_EQ(of_exact.status, QueryStatus::kDone);
          EXPECT_LE(of_exact.distance.lower, distance + kRounding);
          EXPECT_GE(of_exact.distance.upper, distance - kRounding);
          EXPECT_LE(of_exact.distance.upper - of_exact.distance.lower, tolerance + kRounding);
          const DistanceResult of_plain = plain.distance(pose, tolerance);
          EXPECT_LE(of_plain.distance.lower, distance + kRounding);
          EXPECT_GE(of_plain.distance.upper, distance - kRounding);
          EXPECT_LE(of_plain.distance.upper - of_plain.distance.lower,
                    std::max(tolerance, 2 * plain.leaf_pairs(pose, {}).resolution));
        }
      }
    }
  }
  EXPECT_GT(touching, least(15, 0));
  EXPECT_GT(apart, least(30, 2));
}

// Errors margin with the farthest vertex, of those that are there.
TEST(QueryDistance, KnowsNothingOfAVertexThatNoTriangleNames) {
  TriangleMesh block = box({0, 0, 0}, {1, 1, 1});
  const SphereTree plain = tree_with_triangles(block, 0.25);
  block.vertices.emplace_back(1e300, -1e300, 1e300);
  const SphereTree odd = tree_with_triangles(block, 0.25);
  Query query(plain, plain), beside(odd, odd);
  for (const double x : {0.5, 1.0, 1.25}) {
    const Eigen::Isometry3d pose = shift({x, 0, 0});
    EXPECT_EQ(beside.leaf_pairs(pose, {}).pad, query.leaf_pairs(pose, {}).pad);
    EXPECT_EQ(beside.distance(pose, 0).distance.lower, query.distance(pose, 0).distance.lower);
    EXPECT_EQ(beside.distance(pose, 0).distance.upper, query.distance(pose, 0).distance.upper);
  }
}

// Two rough spheres, one in the other. They are nearly as near to each other in many places, so the
// search finds the nearest place late, and far from where it began.
TEST(QueryDistance, OfShellsThatAreNearInManyPlaces) {
  Random random(11);
  const auto rough = [&](double radius) {
    TriangleMesh mesh = icosphere(3, radius);
    for (Eigen::Vector3d& v : mesh.vertices) v *= 1 + random.uniform(-0.02, 0.02);
    return mesh;
  };
  for (int i = 0; i < samples(4); ++i) {
    const SphereTree fixed = triangle_tree(rough(1.06), 60),
                     moving = triangle_tree(rough(0.95), 60);
    Query query(fixed, moving);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Isometry3d pose = pose_of(random.rotation(), {0, 0, 0});
      const double distance =
          mesh_distance(parts_of(fixed).triangles->mesh, parts_of(moving).triangles->mesh, pose);
      ASSERT_GT(distance, 0);
      for (const double tolerance : {0.0, 0.3 * distance}) {
        const DistanceInterval gap = query.distance(pose, tolerance).distance;
        EXPECT_LE(gap.lower, distance + kRounding);
        EXPECT_GE(gap.upper, distance - kRounding);
        EXPECT_LE(gap.upper - gap.lower, tolerance + kRounding);
      }
    }
  }
}

// The nearest points are corners of cubes, on one line through the cubes' centres. There the
// spheres round the cubes are as far apart as the points: nothing is left but the pad.
TEST(QueryDistance, OfCornersIsNoneTheLess) {
  const TriangleMesh mesh = joined(triangle({0, 0, 0}, {1, 0, 0.5}, {0, 0.5, 1}),
                                   triangle({1, 1, 1}, {0, 1, 0.5}, {1, 0.5, 0}));
  Random random(5);
  for (const double cells : {1.0, 4.0, 16.0}) {
    const SphereTree tree = tree_of(mesh, cells);
    for (const SpherePolicy policy : {SpherePolicy::kSimple, SpherePolicy::kTable}) {
      QueryOptions options;
      options.policy = policy;
      Query query(tree, tree, options);
      for (int i = 0; i < samples(50); ++i) {
        const double away = 1 + random.uniform(0, 1);  // exactly: a multiple of 2^-32
        const double distance = std::sqrt(3.0) * (away - 1);
        const Eigen::Isometry3d pose = shift({away, away, away});
        const DistanceInterval gap = query.distance(pose, 0).distance;
        EXPECT_LE(gap.lower, distance * (1 + 0x1p-52)) << away;
        EXPECT_GE(gap.lower, distance - 1e-4);
        for (const std::uint64_t tests : {2u, 20u, 10'000u}) {
          EXPECT_LE(query.leaf_pairs(pose, {}, {.tests = tests}).distance->lower,
                    distance * (1 + 0x1p-52));
        }
      }
    }
  }
}

class QueryDistanceOfBalls : public ::testing::Test {
 protected:
  const SphereTree tree_ = triangle_tree(icosphere(3, 1), 20);
  Query query_{tree_, tree_};
};

TEST_F(QueryDistanceOfBalls, FarAway) {
  const double near = query_.distance(shift({3, 0, 0}), 0).distance.upper;
  for (const double away : {1e2, 1e4}) {
    const DistanceInterval gap = query_.distance(shift({away, 0, 0}), 0).distance;
    EXPECT_LE(gap.lower, near + away - 3);
    EXPECT_GE(gap.upper, near + away - 3);
    EXPECT_LE(gap.upper - gap.lower, 1e-6 * away);
  }
  for (const double away : {1e6, 1e12, 1e30, 1e200}) {  // that of the roots
    const DistanceInterval gap = query_.distance(shift({away, 0, 0}), 0).distance;
    EXPECT_LE(gap.lower, near + away - 3);
    EXPECT_GE(gap.upper, near + away - 3);
    EXPECT_LE(gap.upper - gap.lower, 8 + 1e-6 * away);
  }
}

TEST_F(QueryDistanceOfBalls, OfATouchIsNothing) {
  const DistanceInterval gap = query_.distance(shift({1.9, 0.1, 0}), 0).distance;
  EXPECT_EQ(gap.lower, 0);
  EXPECT_EQ(gap.upper, 0);
}

TEST_F(QueryDistanceOfBalls, WithAToleranceThatIsNoneIsThatOfZero) {
  const Eigen::Isometry3d pose = shift({2.5, 0.3, 0.1});
  const DistanceInterval wanted = query_.distance(pose, 0).distance;
  for (const double tolerance : {-1.0, -0.0, std::numeric_limits<double>::quiet_NaN()}) {
    const DistanceInterval gap = query_.distance(pose, tolerance).distance;
    EXPECT_EQ(gap.lower, wanted.lower);
    EXPECT_EQ(gap.upper, wanted.upper);
  }
}

TEST_F(QueryDistanceOfBalls, OfAnInvalidPoseIsAStatus) {
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.matrix()(1, 1) = -1;
  EXPECT_EQ(query_.distance(bad, 0).status, QueryStatus::kInvalidPose);
}

TEST(InsideTest, TellsWhoIsInWhom) {
  const TriangleMesh large = icosphere(2, 3), small = box({-1, -1, -1}, {1, 1, 1});
  const TriangleMesh two = joined(small, moved(small, {10, 0, 0}));
  const TriangleMesh turned = inside_out(large), shell = joined(large, icosphere(2, 2));
  const Eigen::Isometry3d here = shift({0.1, 0.2, 0.3}), there = shift({7, 0, 0});
  EXPECT_EQ(InsideTest(large, small).at(here), Inside::kMoving);
  EXPECT_EQ(InsideTest(small, large).at(here), Inside::kFixed);
  EXPECT_EQ(InsideTest(turned, small).at(here), Inside::kMoving);
  EXPECT_EQ(InsideTest(large, small).at(there), Inside::kNone);
  EXPECT_EQ(InsideTest(large, two).at(here), Inside::kNone);  // one of two
  EXPECT_EQ(InsideTest(shell, small).at(here), Inside::kMoving);
  EXPECT_STREQ(to_string(Inside::kMoving), "moving");
}

TEST(QueryInside, TellsWhoIsInWhom) {
  const TriangleMesh small = box({-1, -1, -1}, {1, 1, 1});
  const SphereTree outer = triangle_tree(icosphere(2, 3), 12), inner = triangle_tree(small, 8),
                   two = triangle_tree(joined(small, moved(small, {10, 0, 0})), 24);
  Query query(outer, inner), other(inner, outer), of_two(outer, two);
  const Eigen::Isometry3d here = shift({0.1, 0.2, 0.3});
  EXPECT_EQ(query.inside(here).inside, Inside::kMoving);
  EXPECT_EQ(other.inside(here).inside, Inside::kFixed);
  EXPECT_EQ(query.inside(shift({7, 0, 0})).inside, Inside::kNone);
  EXPECT_EQ(of_two.inside(here).inside, Inside::kNone);  // one of two
  // Through the surface, with each vertex of the one or of the other face inside.
  for (const double side : {-2.5, 2.5}) {
    const Eigen::Isometry3d across = shift({side, 0, 0});
    ASSERT_EQ(query.intersects(across).answer, Answer::kYes);
    EXPECT_EQ(query.inside(across).inside, Inside::kNone);
    EXPECT_EQ(query.inside(across).status, QueryStatus::kDone);
  }
}

TEST(QueryInside, SaysWhyThereIsNoAnswer) {
  const TriangleMesh mesh = icosphere(2, 3);
  const SphereTree tree = triangle_tree(mesh, 12), plain = tree_of(mesh, 12);
  Query query(tree, tree), without(tree, plain);
  EXPECT_EQ(without.inside(shift({0, 0, 0})).status, QueryStatus::kNoTriangles);
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.matrix()(1, 1) = -1;
  EXPECT_EQ(query.inside(bad).status, QueryStatus::kInvalidPose);
  bad.matrix()(1, 1) = 1 + 1e-6;
  const InsideResult nearly = query.inside(bad);
  EXPECT_EQ(nearly.status, QueryStatus::kDone);
  EXPECT_EQ(nearly.rotation_error, rotation_error(bad));
  EXPECT_GT(nearly.rotation_error, 0);
}

}  // namespace
}  // namespace ist::test
