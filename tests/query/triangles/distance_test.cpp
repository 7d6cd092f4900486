#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ist/query/inside.h"
#include "ist/query/query.h"
#include "ist/query/triangles/triangle_distance.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "query/triangles/mesh_distance.h"
#include "query/triangles/triangle_tree.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kPlainDistanceError = 0x1p-40;

// The distance of two edges along their common perpendicular, or nothing if it misses an edge.
void nearest_of_edges(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c,
                      const ExactPoint& d, mpq_class& least) {
  const ExactPoint u = b - a, v = d - c, w = c - a, n = cross(u, v);
  const mpq_class nn = square(n);
  if (nn == 0) return;
  const mpq_class s = dot(cross(w, v), n) / nn, t = dot(cross(w, u), n) / nn;
  if (s < 0 || s > 1 || t < 0 || t > 1) return;
  const mpq_class height = dot(w, n);
  least = std::min<mpq_class>(least, height * height / nn);
}

double exact_distance(const TriangleCorners& a, const TriangleCorners& b) {
  const ExactPolygon p = exact_triangle(a), q = exact_triangle(b);
  mpq_class least = distance_squared(p[0], q);
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min(least, distance_squared(p[i], q));
    least = std::min(least, distance_squared(q[i], p));
    for (std::size_t j = 0; j < 3; ++j) {
      nearest_of_edges(p[i], p[(i + 1) % 3], q[j], q[(j + 1) % 3], least);
    }
  }
  return std::sqrt(least.get_d());
}

template <class Number>
int expect_near(int times, const Number& number) {
  int apart = 0, farther = 0;
  for (int i = 0; i < times && !::testing::Test::HasFailure(); ++i) {
    TriangleCorners a, b;
    double longest = 0;
    for (TriangleCorners* t : {&a, &b}) {
      for (Eigen::Vector3d& x : *t) x = {number(), number(), number()};
      for (std::size_t k = 0; k < 3; ++k) {
        longest = std::max(longest, ((*t)[k] - (*t)[(k + 1) % 3]).norm());
      }
    }
    if (polygons_meet(exact_triangle(a), exact_triangle(b))) continue;
    ++apart;
    const double wanted = exact_distance(a, b), made = std::sqrt(ist::distance_squared(a, b));
    EXPECT_NEAR(made, wanted, kTriangleDistanceError * std::max(longest, wanted));
    EXPECT_EQ(made, std::sqrt(ist::distance_squared(b, a)));
    // The other tests compare with this distance.
    EXPECT_NEAR(mesh_distance(triangle(a[0], a[1], a[2]), triangle(b[0], b[1], b[2]),
                              Eigen::Isometry3d::Identity()),
                wanted, kPlainDistanceError * std::max(longest, wanted));
    EXPECT_LE(std::sqrt(box_distance_squared(a, b)), wanted * (1 + 1e-15));
    EXPECT_FALSE(surely_farther(a, b, wanted * (1 + 1e-15)));
    farther += surely_farther(a, b, 0.9 * wanted) ? 1 : 0;
  }
  EXPECT_GT(farther, apart / 16);
  return apart;
}

TEST(TriangleDistance, OfAnyTriangles) {
  Random random(1);
  EXPECT_GT(expect_near(samples(3'000), [&] { return random.uniform(-1, 1); }), samples(1'500));
}

// Parallel edges and planes, and triangles without area.
TEST(TriangleDistance, OfTrianglesOnAGrid) {
  Random random(2);
  for (const std::size_t size : {2u, 3u, 5u}) {
    const auto number = [&] { return 0.1 * static_cast<double>(random.below(size)); };
    EXPECT_GT(expect_near(samples(1'500), number), samples(100));
  }
}

TEST(TriangleDistance, OfSliversThatAreNearlyParallel) {
  Random random(3);
  for (const double width : {1e-3, 1e-6, 1e-9, 1e-12}) {
    int at = 0;  // long along x, and all but flat elsewhere
    const auto number = [&] {
      return at++ % 3 == 0 ? random.uniform(-1, 1) : width * random.uniform(-1, 1);
    };
    EXPECT_GT(expect_near(samples(800), number), samples(200));
  }
}

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

TEST(QueryDistance, HoldsTheDistanceWithVoxelsAndWithout) {
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{40}); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const double away = std::ldexp(1.0, static_cast<int>(random.below(12)) - 4);
    const Eigen::Isometry3d pose = pose_of(random.rotation(), away * random.direction());
    const double exact = mesh_distance(a, b, pose);
    for_voxels_or_none(a, b, 0.3, [&](const SphereTree& fixed, const SphereTree& moving) {
      Query query(fixed, moving);
      for (const double tolerance : {0.0, 0.01}) {
        const DistanceResult found = query.distance(pose, tolerance);
        ASSERT_EQ(found.status, QueryStatus::kDone);
        const double rounding = kRounding * (1 + away);
        EXPECT_LE(found.distance.lower, exact + rounding);
        EXPECT_GE(found.distance.upper, exact - rounding);
        EXPECT_LE(found.distance.upper - found.distance.lower, tolerance + rounding);
      }
    });
  }
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
  for (const double away : {1e6, 1e12, 1e30, 1e200}) {  // the distance of the roots
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

TEST(QueryInside, IsTheSameWithVoxelsAndWithout) {
  const auto expect = [](const TriangleMesh& a, const TriangleMesh& b, Inside inside) {
    for_voxels_or_none(a, b, 0.3, [&](const SphereTree& fixed, const SphereTree& moving) {
      Query query(fixed, moving);
      const InsideResult found = query.inside(shift({0.1, 0, 0}));
      EXPECT_EQ(found.status, QueryStatus::kDone);
      EXPECT_EQ(found.inside, inside);
    });
  };
  const TriangleMesh large = icosphere(2, 3), small = icosphere(1, 1);
  expect(large, small, Inside::kMoving);
  expect(small, large, Inside::kFixed);
  expect(large, large, Inside::kNone);
  expect(small, moved(small, {9, 0, 0}), Inside::kNone);
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
