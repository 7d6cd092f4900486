#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/triangles/triangle_distance.h"
#include "query/query_cases.h"
#include "query/test_clocks.h"
#include "query/triangles/mesh_distance.h"
#include "query/triangles/triangle_tree.h"
#include "simd/targets.h"
#include "support/effort.h"
#include "support/rigid_pose.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;

// Coordinates of the tests are no larger than this.
constexpr double kNearRounding = 1e-12;

TriangleCorners corners(const TriangleMesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}
TriangleCorners corners(const TriangleMesh& mesh, std::uint32_t triangle,
                        const Eigen::Isometry3d& pose) {
  TriangleCorners t = corners(mesh, triangle);
  for (Vector& p : t) p = pose * p;
  return t;
}

double from_part(const Vector& p, const TriangleCorners& t, TrianglePart part) {
  const auto number = static_cast<std::size_t>(part);
  const auto at = [](const Vector& v) { return plain::Vector(v.cast<long double>()); };
  if (number < 3) return (p - t[number]).norm();
  if (number < 6) {
    return static_cast<double>(
        std::sqrt(plain::from_segment(at(p), at(t[number - 3]), at(t[(number - 2) % 3]))));
  }
  return static_cast<double>(std::sqrt(plain::from_triangle(at(p), plain::Corners(t))));
}

// The points lie on the parts that are named, and are as far apart as the pair says.
void expect_points(const NearPair& pair, const TriangleCorners& a, const TriangleCorners& b,
                   double error) {
  EXPECT_LE(from_part(pair.fixed_point, a, pair.fixed_part), error);
  EXPECT_LE(from_part(pair.moving_point, b, pair.moving_part), error);
  EXPECT_NEAR((pair.fixed_point - pair.moving_point).norm(), pair.distance, error);
  if (pair.distance > error) {
    EXPECT_NEAR(pair.direction().norm(), 1, 1e-12);
  }
}

double size_of(const TriangleCorners& a, const TriangleCorners& b) {
  double longest = 0;
  for (const TriangleCorners* t : {&a, &b}) {
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, ((*t)[k] - (*t)[(k + 1) % 3]).norm());
    }
  }
  return longest;
}

template <class Number>
int expect_closest(int times, const Number& number) {
  int meeting = 0;
  for (int i = 0; i < times && !::testing::Test::HasFailure(); ++i) {
    TriangleCorners a, b;
    for (TriangleCorners* t : {&a, &b}) {
      for (Vector& x : *t) x = {number(), number(), number()};
    }
    const bool meets = polygons_meet(exact_triangle(a), exact_triangle(b));
    meeting += meets ? 1 : 0;
    const NearPair pair = closest_points(a, b, {3, 4});
    EXPECT_EQ(pair.triangles, (TrianglePair{3, 4}));
    const double wanted = meets ? 0 : plain::distance(plain::Corners(a), plain::Corners(b));
    const double error = 4 * kTriangleDistanceError * std::max(size_of(a, b), wanted);
    EXPECT_NEAR(pair.distance, wanted, error);
    if (meets) {
      EXPECT_EQ(pair.distance, 0);
      EXPECT_TRUE(pair.direction().isZero());
      EXPECT_EQ(pair.fixed_point, pair.moving_point);
    }
    expect_points(pair, a, b, error);
  }
  return meeting;
}

TEST(ClosestPoints, OfAnyTriangles) {
  Random random(1);
  EXPECT_GT(expect_closest(samples(3'000), [&] { return random.uniform(-1, 1); }), samples(200));
}

// Parallel edges and planes, common corners, and triangles without area.
TEST(ClosestPoints, OfTrianglesOnAGrid) {
  Random random(2);
  for (const std::size_t size : {2u, 3u, 5u}) {
    const auto number = [&] { return 0.1 * static_cast<double>(random.below(size)); };
    EXPECT_GT(expect_closest(samples(1'500), number), samples(100));
  }
}

TEST(ClosestPoints, OfSliversThatAreNearlyParallel) {
  Random random(3);
  for (const double width : {1e-3, 1e-6, 1e-9}) {
    int at = 0;
    expect_closest(samples(500), [&] {
      return at++ % 3 == 0 ? random.uniform(-1, 1) : width * random.uniform(-1, 1);
    });
  }
}

// A long edge through the middle of a large face: no border of either triangle is near the other's.
TEST(ClosestPoints, OfAnEdgeThroughAFace) {
  const TriangleCorners face{Vector(-9, -9, 0), Vector(9, -9, 0), Vector(0, 9, 0)};
  const TriangleCorners pin{Vector(0.25, 0.5, -5), Vector(0.25, 0.5, 5), Vector(8, 8, 7)};
  const NearPair pair = closest_points(face, pin, {0, 0});
  EXPECT_EQ(pair.distance, 0);
  EXPECT_LE((pair.fixed_point - Vector(0.25, 0.5, 0)).norm(), kNearRounding);
  EXPECT_EQ(pair.fixed_part, TrianglePart::kFace);
  EXPECT_EQ(pair.moving_part, TrianglePart::kEdge0);
}

// Asks for the pairs of two bodies, and compares with all pairs of their triangles.
std::size_t expect_all(const SphereTree& fixed, const SphereTree& moving,
                       const Eigen::Isometry3d& pose, double margin,
                       const std::vector<std::string>& targets) {
  std::vector<NearPair> first;
  for (const std::string& target : targets) {
    SCOPED_TRACE(target);
    Query query(fixed, moving, {.target = target});
    std::vector<NearPair> pairs(1 << 14);
    const NearPairsResult result = query.near_pairs(pose, margin, pairs);
    EXPECT_EQ(result.status, QueryStatus::kDone);
    EXPECT_TRUE(result.complete);
    EXPECT_FALSE(result.truncated);
    pairs.resize(result.near_pairs);
    EXPECT_TRUE(std::ranges::is_sorted(
        pairs, {}, [](const NearPair& p) { return std::pair(p.distance, p.triangles); }));
    std::set<TrianglePair> listed;
    const TriangleMesh &a = *fixed.triangles(), &b = *moving.triangles();
    for (const NearPair& pair : pairs) {
      EXPECT_TRUE(listed.insert(pair.triangles).second);
      expect_points(pair, corners(a, pair.triangles.fixed), corners(b, pair.triangles.moving, pose),
                    result.pad + kNearRounding);
    }
    for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
      const plain::Corners of_fixed(corners(a, i));
      for (std::uint32_t j = 0; j < b.triangles.size(); ++j) {
        const plain::Corners of_moving(corners(b, j, pose));
        const double far = margin + result.pad + kNearRounding;
        if (of_fixed.box.squaredExteriorDistance(of_moving.box) > far * far) {
          EXPECT_FALSE(listed.contains({i, j}));
          continue;
        }
        const double distance =
            plain::meet(of_fixed, of_moving) ? 0 : plain::distance(of_fixed, of_moving);
        if (distance < margin - kNearRounding) {
          EXPECT_TRUE(listed.contains({i, j})) << distance;
        }
        if (distance > far) {
          EXPECT_FALSE(listed.contains({i, j})) << distance;
        }
      }
    }
    if (first.empty()) first = pairs;
    EXPECT_EQ(first.size(), pairs.size());
    for (std::size_t k = 0; k < std::min(first.size(), pairs.size()); ++k) {
      EXPECT_EQ(std::memcmp(&first[k].distance, &pairs[k].distance, 7 * sizeof(double)), 0);
      EXPECT_EQ(first[k].triangles, pairs[k].triangles);
      EXPECT_EQ(std::tuple(first[k].fixed_part, first[k].moving_part),
                std::tuple(pairs[k].fixed_part, pairs[k].moving_part));
    }
  }
  return first.size();
}

TEST(NearPairs, OfRandomBodies) {
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{30}) && !::testing::Test::HasFailure();
       ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const SphereTree fixed = triangle_tree(a, 4), moving = triangle_tree(b, 4);
    for (const double margin : {0.0, 1e-6, 1e-3, 0.1, 1.0, 10.0}) {
      const Eigen::Matrix3d rotation = random.rotation();
      const Vector to = a.vertices[random.below(a.vertices.size())] -
                        rotation * b.vertices[random.below(b.vertices.size())];
      const Eigen::Isometry3d pose =
          pose_of(rotation, to + random.uniform(0, 1.5) * margin * random.direction());
      found += expect_all(fixed, moving, pose, margin, all_targets());
    }
  }
  EXPECT_GT(found, samples(1'000u));
}

// Faces on faces, edges on edges, corners on corners: tangent and coplanar, in rational numbers.
TEST(NearPairs, OfBoxesOnOneLattice) {
  const SphereTree fixed = triangle_tree(box({0, 0, 0}, {3, 3, 3}), 3),
                   moving = triangle_tree(box({0, 0, 0}, {2, 3, 1}), 6);
  std::size_t found = 0;
  for (const Eigen::Matrix3d& rotation : quarter_turns()) {
    for (const double x : {-3.0, 0.0, 1.0, 3.0, 4.0}) {
      for (const double margin : {0.0, 0.5, 1.0}) {
        found += expect_all(fixed, moving, pose_of(rotation, {x, 1, -x}), margin, {"scalar"});
      }
    }
  }
  EXPECT_GT(found, 1'000u);
}

TEST(NearPairs, HaveTheDistanceOfTheBodiesFirst) {
  const SphereTree ball = triangle_tree(icosphere(3, 1), 8);
  Query query(ball, ball);
  const Eigen::Isometry3d pose = pose_of(Random(4).rotation(), {2.03, 0.1, -0.2});
  std::vector<NearPair> pairs(64);
  const NearPairsResult found = query.near_pairs(pose, 0.1, pairs);
  const DistanceResult distance = query.distance(pose, 0);
  ASSERT_TRUE(distance.nearest);
  ASSERT_GT(found.near_pairs, 0u);
  EXPECT_EQ(pairs[0].distance, distance.nearest->distance);
  EXPECT_EQ(pairs[0].triangles, distance.nearest->triangles);
  EXPECT_LE(distance.distance.lower, pairs[0].distance);
  EXPECT_GE(distance.distance.upper, pairs[0].distance);
}

// A short span holds the nearest pairs, however the search comes to them.
TEST(NearPairs, OfAShortSpanAreTheNearest) {
  const SphereTree a = triangle_tree(icosphere(3, 1), 8), b = triangle_tree(icosphere(4, 1), 8);
  Query query(a, b);
  const Eigen::Isometry3d pose = shift({2.01, 0, 0});
  std::vector<NearPair> all(1 << 12);
  const NearPairsResult whole = query.near_pairs(pose, 0.1, all);
  ASSERT_GT(whole.near_pairs, 100u);
  for (const std::size_t room : {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{99},
                                 std::size_t{whole.near_pairs}}) {
    std::vector<NearPair> some(room);
    const NearPairsResult found = query.near_pairs(pose, 0.1, some);
    EXPECT_EQ(found.near_pairs, whole.near_pairs);
    EXPECT_EQ(found.truncated, room < whole.near_pairs);
    for (std::size_t k = 0; k < room; ++k) EXPECT_EQ(some[k].triangles, all[k].triangles);
  }
}

TEST(NearPairs, OfABudgetAreSomeAndTheSameOnEveryTarget) {
  const SphereTree a = triangle_tree(icosphere(4, 1), 8), b = triangle_tree(icosphere(4, 1), 8);
  const Eigen::Isometry3d pose = shift({2.005, 0.1, 0});
  std::vector<std::uint64_t> counts;
  for (const std::string& target : all_targets()) {
    Query query(a, b, {.target = target});
    std::vector<NearPair> pairs(1 << 12);
    const NearPairsResult whole = query.near_pairs(pose, 0.1, pairs);
    std::size_t at = 0;
    for (const std::uint64_t most : {0u, 1u, 100u, 1'000u, 3'000u, 10'000u, 1'000'000u}) {
      Budget budget;
      budget.tests = most;
      const NearPairsResult found = query.near_pairs(pose, 0.1, pairs, budget);
      EXPECT_LE(found.sphere_tests, std::max<std::uint64_t>(most, 1));
      EXPECT_EQ(found.complete, found.near_pairs == whole.near_pairs);
      if (counts.size() <= at) counts.push_back(found.near_pairs);
      EXPECT_EQ(found.near_pairs, counts[at++]) << target;
    }
    const ScopedBudgetClock clock(&LateClock::now);
    const NearPairsResult late = query.near_pairs(pose, 0.1, pairs, LateClock::budget_of(0));
    EXPECT_FALSE(late.complete);
  }
}

TEST(NearPairs, RefuseWhatCannotBeAnswered) {
  const SphereTree tree = triangle_tree(icosphere(1, 1), 8);
  Query query(tree, tree), plain(without_triangles(tree), tree);
  std::array<NearPair, Query::kMostNearParts> out;
  const Eigen::Isometry3d pose = shift({2, 0, 0});
  for (const double margin : {-1e-9, -HUGE_VAL, HUGE_VAL, std::nan("")}) {
    EXPECT_EQ(query.near_pairs(pose, margin, out).status, QueryStatus::kMarginInvalid);
    EXPECT_EQ(query.near_parts(pose, {0, 0}, margin, out).status, QueryStatus::kMarginInvalid);
  }
  EXPECT_EQ(plain.near_pairs(pose, 1, out).status, QueryStatus::kNoTriangles);
  EXPECT_EQ(plain.near_parts(pose, {0, 0}, 1, out).status, QueryStatus::kNoTriangles);
  Eigen::Isometry3d bent = pose;
  bent.linear() *= 2;
  EXPECT_EQ(query.near_pairs(bent, 1, out).status, QueryStatus::kInvalidPose);
  EXPECT_EQ(query.near_parts(bent, {0, 0}, 1, out).status, QueryStatus::kInvalidPose);
  EXPECT_EQ(query.near_parts(pose, {80, 0}, 1, out).status, QueryStatus::kNoSuchTriangle);
  EXPECT_EQ(query.near_parts(pose, {0, 80}, 1, out).status, QueryStatus::kNoSuchTriangle);
  // A margin that is larger than the world is near to all.
  const std::uint64_t all = tree.triangles()->triangles.size() * tree.triangles()->triangles.size();
  EXPECT_EQ(query.near_pairs(pose, 1e300, out).near_pairs, all);
  const NearPairsResult far = query.near_pairs(shift({1e30, 0, 0}), 1, out);
  EXPECT_TRUE(far.complete);
  EXPECT_EQ(far.near_pairs, 0u);
}

// An edge that lies along a face has three parts near it: its ends above the face, and more.
TEST(NearParts, OfAnEdgeAlongAFaceAreMoreThanOne) {
  const TriangleMesh face = triangle({-9, -9, 0}, {9, -9, 0}, {0, 9, 0});
  const TriangleMesh wedge = triangle({-1, 0, 0}, {1, 0, 0}, {0, 0, 5});
  const SphereTree a = triangle_tree(face, 4), b = triangle_tree(wedge, 4);
  Query query(a, b);
  std::array<NearPair, Query::kMostNearParts> out;
  const NearPairsResult found = query.near_parts(shift({0, 0, 0.25}), {0, 0}, 0.5, out);
  ASSERT_EQ(found.near_pairs, 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(out[k].fixed_part, TrianglePart::kFace);
    EXPECT_EQ(out[k].distance, 0.25);
    EXPECT_TRUE(out[k].direction().isApprox(Vector(0, 0, 1)));
  }
  EXPECT_NE(out[0].moving_part, out[1].moving_part);
}

// Every part that is listed is right, none is listed twice, and the nearest is the pair's.
TEST(NearParts, OfRandomTriangles) {
  Random random(6);
  std::size_t listed = 0;
  for (int i = 0; i < samples(300) && !HasFailure(); ++i) {
    const auto any = [&] {
      const Vector p = random.point(-1, 1), q = random.point(-1, 1);
      return triangle(p, q, random.point(-1, 1));
    };
    const TriangleMesh a = any(), b = any();
    const SphereTree fixed = triangle_tree(a, 3), moving = triangle_tree(b, 3);
    Query query(fixed, moving);
    const Eigen::Isometry3d pose = pose_of(random.rotation(), 3 * random.direction());
    std::array<NearPair, Query::kMostNearParts> out;
    const double margin = random.uniform(0, 4);
    const NearPairsResult found = query.near_parts(pose, {0, 0}, margin, out);
    NearPair nearest;
    const NearPairsResult whole = query.near_pairs(pose, margin, {&nearest, 1});
    EXPECT_EQ(found.near_pairs > 0, whole.near_pairs > 0);
    std::set<std::pair<TrianglePart, TrianglePart>> parts;
    for (std::size_t k = 0; k < found.near_pairs; ++k) {
      EXPECT_TRUE(parts.emplace(out[k].fixed_part, out[k].moving_part).second);
      EXPECT_LE(out[k].distance, margin + found.pad);
      if (k > 0) {
        EXPECT_GE(out[k].distance, out[k - 1].distance);
      }
      expect_points(out[k], corners(*fixed.triangles(), 0), corners(*moving.triangles(), 0, pose),
                    found.pad + kNearRounding);
    }
    if (found.near_pairs > 0) {
      EXPECT_EQ(out[0].distance, nearest.distance);
    }
    listed += found.near_pairs;
  }
  EXPECT_GT(listed, samples(300u));
}

// At every tolerance the points are those of a pair whose distance the interval holds.
TEST(QueryDistance, TellsItsPoints) {
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{40}) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const SphereTree fixed = triangle_tree(a, 4), moving = triangle_tree(b, 4);
    Query query(fixed, moving);
    for (const double tolerance : {0.0, 0.01, 0.5}) {
      const Eigen::Isometry3d pose = pose_of(random.rotation(), random.point(-3, 3));
      const DistanceResult found = query.distance(pose, tolerance);
      ASSERT_TRUE(found.nearest);
      const NearPair& pair = *found.nearest;
      EXPECT_LE(found.distance.lower, pair.distance);
      EXPECT_GE(found.distance.upper, pair.distance);
      expect_points(pair, corners(*fixed.triangles(), pair.triangles.fixed),
                    corners(*moving.triangles(), pair.triangles.moving, pose),
                    found.narrowest + kNearRounding);
    }
  }
}

// Bodies that intersect have the same common point on every target, whatever was asked before.
TEST(QueryDistance, OfBodiesThatIntersectHasOnePointOnEveryTarget) {
  const SphereTree ball = triangle_tree(icosphere(3, 1), 8);
  for (const double x : {0.3, 1.2, 1.9}) {
    const Eigen::Isometry3d pose = pose_of(Random(9).rotation(), {x, 0.1, 0.05});
    std::vector<NearPair> found;
    for (const std::string& target : all_targets()) {
      for (const bool asks_before : {false, true}) {
        Query query(ball, ball, {.target = target});
        if (asks_before) {
          EXPECT_EQ(query.intersects(pose).answer, Answer::kYes);
        }
        const DistanceResult result = query.distance(pose, 0);
        ASSERT_TRUE(result.nearest);
        EXPECT_EQ(result.distance.upper, 0);
        found.push_back(*result.nearest);
        EXPECT_EQ(found.back().triangles, found.front().triangles) << target;
        EXPECT_EQ(found.back().fixed_point, found.front().fixed_point) << target;
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
