#include "ist/constraint/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <vector>

#include "haptics/wall/fine_bodies.h"
#include "ist/query/query.h"
#include "loop/haptics/wall/wall_pair.h"
#include "query/query_cases.h"
#include "query/triangles/mesh_distance.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Kind = SurfacePart::Kind;
using Which = FeatureList::Which;
using Parts = std::tuple<Kind, std::uint32_t, Kind, std::uint32_t>;

// Numbers of the tests are no larger than 10.
constexpr double kLengthRounding = 1e-11;

Parts parts_of(const Feature& f) {
  return {f.fixed.kind, f.fixed.index, f.moving.kind, f.moving.index};
}

struct FeatureBodies {
  FeatureBodies(const TriangleMesh& a, const TriangleMesh& b)
      : fixed(build_tree(a)), moving(build_tree(b)), query(fixed.tree, moving.tree) {}

  std::vector<Feature> list(const Eigen::Isometry3d& pose, double margin, Which which,
                            std::size_t room = 1 << 12, bool thinned = false) {
    std::vector<NearPair> near(1 << 16);
    const NearPairsResult found = query.near_pairs(pose, margin, near);
    EXPECT_FALSE(found.truncated);
    near.resize(found.near_pairs);
    FeatureList features(fixed.surface, moving.surface, room);
    features.find(near, pose, margin, which);
    EXPECT_EQ(features.is_thinned(), thinned);
    return {features.features().begin(), features.features().end()};
  }

  WallBody fixed, moving;
  Query query;
};

Eigen::Matrix3d turn(double degrees, const Vector& axis) {
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
}

// Turns the diagonal of a cube upright.
Eigen::Matrix3d on_its_corner() {
  return Eigen::Quaterniond::FromTwoVectors(Vector(1, 1, 1), Vector(0, 0, 1)).toRotationMatrix();
}

void expect_one(const std::vector<Feature>& features, Kind fixed, Kind moving, const Vector& at,
                double gap) {
  ASSERT_EQ(features.size(), 1u);
  const Feature& f = features[0];
  EXPECT_EQ(f.fixed.kind, fixed);
  EXPECT_EQ(f.moving.kind, moving);
  EXPECT_NEAR(f.gap, gap, kLengthRounding);
  EXPECT_LE((f.normal - Vector::UnitZ()).norm(), 1e-8);
  EXPECT_LE((f.fixed_point - at).norm(), kLengthRounding);
  EXPECT_LE((f.moving_point - at - gap * Vector::UnitZ()).norm(), kLengthRounding);
}

TEST(FeatureList, OfACornerOverAPlateIsOne) {
  const TriangleMesh cube = fine_box({1, 1, 1}, 3);
  const double height = 0.5 * std::sqrt(3.0) + 0.01;
  for (const int n : {1, 2, 9}) {
    const TriangleMesh plate = moved(fine_box({4, 4, 1}, n), {0, 0, -0.5});
    const Eigen::Isometry3d pose =
        pose_of(turn(17, Vector::UnitZ()) * on_its_corner(), {0.31, 0.17, height});
    expect_one(FeatureBodies(plate, cube).list(pose, 0.05, Which::kMinima), Kind::kFace,
               Kind::kVertex, {0.31, 0.17, 0}, 0.01);
    // A plate over a corner.
    const TriangleMesh over = moved(plate, {0, 0, 1});
    FeatureBodies bodies(turned(cube, on_its_corner()), over);
    const Eigen::Isometry3d above = pose_of(turn(17, Vector::UnitZ()), {0.31, 0.17, height});
    expect_one(bodies.list(above, 0.05, Which::kMinima), Kind::kVertex, Kind::kFace,
               {0, 0, 0.5 * std::sqrt(3.0)}, 0.01);
  }
}

TEST(FeatureList, OfAnEdgeAcrossAnEdgeIsOne) {
  const double half = 0.5 * std::sqrt(2.0);
  const TriangleMesh bar = turned(box({-2, -0.5, -0.5}, {2, 0.5, 0.5}), turn(45, Vector::UnitX()));
  FeatureBodies bodies(bar, bar);
  for (const double angle : {90.0, 60.0, 17.0, -30.0}) {
    const Eigen::Isometry3d pose = pose_of(turn(angle, Vector::UnitZ()), {0, 0, 2 * half + 0.01});
    expect_one(bodies.list(pose, 0.02, Which::kMinima), Kind::kEdge, Kind::kEdge, {0, 0, half},
               0.01);
  }
}

// Its four corners and nothing else. A corner above a seam can be above it and the faces beside
// it.
void expect_corners(FeatureBodies& bodies, const Eigen::Isometry3d& pose, bool on_seams) {
  const std::vector<Feature> features = bodies.list(pose, 0.05, Which::kMinima);
  std::set<std::uint32_t> vertices;
  for (const Feature& f : features) {
    EXPECT_EQ(f.moving.kind, Kind::kVertex);
    vertices.insert(f.moving.index);
    const Vector p = bodies.moving.surface.mesh().vertices[f.moving.index];
    EXPECT_EQ(p.cwiseAbs(), Vector(0.5, 0.25, 0.5));
    EXPECT_EQ(p[2], -0.5);
    EXPECT_LE((f.normal - Vector::UnitZ()).norm(), 1e-8);
    EXPECT_NEAR(f.gap, 0.01, kLengthRounding);
  }
  EXPECT_EQ(vertices.size(), 4u);
  if (!on_seams) {
    EXPECT_EQ(features.size(), 4u);
  }
}

TEST(FeatureList, OfABoxOnAPlateAreItsCorners) {
  for (const int of_plate : {1, 5, 40}) {
    FeatureBodies bodies(moved(fine_box({4, 4, 1}, of_plate), {0, 0, -0.5}),
                         fine_box({1, 0.5, 1}, 1));
    for (const double angle : {17.0, 0.3, 45.0, 90.0, 0.0}) {
      SCOPED_TRACE(angle);
      expect_corners(bodies, pose_of(turn(angle, Vector::UnitZ()), {0.1234, 0.0567, 0.51}), false);
    }
  }
}

// Corners above the edges and vertices inside the plate, to within rounding.
TEST(FeatureList, OfABoxOverSeamsAreItsCorners) {
  Random random(1);
  for (int i = 0; i < samples(40) && !HasFailure(); ++i) {
    const Eigen::Matrix3d plate_turn = turn(random.uniform(0, 90), Vector::UnitZ());
    FeatureBodies bodies(turned(moved(fine_box({4, 4, 1}, 16), {0, 0, -0.5}), plate_turn),
                         fine_box({1, 0.5, 1}, 1));
    for (const Vector& at : {Vector(0, 0, 0.51), Vector(0.125, 0, 0.51), Vector(0.1, 0.1, 0.51)}) {
      SCOPED_TRACE(at.transpose());
      expect_corners(bodies, pose_of(plate_turn, plate_turn * at), true);
    }
  }
}

// The closest points of two edges by plain code, if both are inside: part of the first, distance.
double inner_distance(const TriangleCorners& a, std::size_t i, const TriangleCorners& b,
                      std::size_t j) {
  const plain::Corners p(a), q(b);
  return static_cast<double>(std::sqrt(
      plain::between_inner_points(p.at[i], p.at[(i + 1) % 3], q.at[j], q.at[(j + 1) % 3])));
}

// The distance from a point to the plane of a triangle, if it is above the inside; else infinity.
double above(const Vector& p, const TriangleCorners& t) {
  const Vector u = t[1] - t[0], v = t[2] - t[0], w = p - t[0], n = u.cross(v);
  const double r = w.cross(v).dot(n) / n.dot(n), s = u.cross(w).dot(n) / n.dot(n);
  const bool inside = std::min({r, s, 1 - r - s}) > 1e-6;
  return inside ? std::abs(w.dot(n)) / n.norm() : HUGE_VAL;
}

TriangleCorners moved_corners(const TriangleMesh& mesh, std::uint32_t t,
                              const Eigen::Isometry3d& pose) {
  const Triangle& of = mesh.triangles[t];
  return {pose * mesh.vertices[of[0]], pose * mesh.vertices[of[1]], pose * mesh.vertices[of[2]]};
}

// All features by all pairs of triangles: corners above faces, and edges across edges.
std::map<Parts, double> brute_features(const FeatureBodies& bodies, const Eigen::Isometry3d& pose,
                                       double margin) {
  const TriangleMesh &a = bodies.fixed.surface.mesh(), &b = bodies.moving.surface.mesh();
  std::map<Parts, double> found;
  const auto add = [&](double gap, const SurfacePart& fixed, const SurfacePart& moving) {
    if (gap < margin - kLengthRounding) {
      found[{fixed.kind, fixed.index, moving.kind, moving.index}] = gap;
    }
  };
  const auto number = [](std::size_t k) { return static_cast<TrianglePart>(k); };
  for (std::uint32_t s = 0; s < a.triangles.size(); ++s) {
    const TriangleCorners p = moved_corners(a, s, Eigen::Isometry3d::Identity());
    for (std::uint32_t t = 0; t < b.triangles.size(); ++t) {
      const TriangleCorners q = moved_corners(b, t, pose);
      const auto fixed = [&](TrianglePart part) { return bodies.fixed.surface.part(s, part); };
      const auto moving = [&](TrianglePart part) { return bodies.moving.surface.part(t, part); };
      for (std::size_t i = 0; i < 3; ++i) {
        add(above(p[i], q), fixed(number(i)), moving(TrianglePart::kFace));
        add(above(q[i], p), fixed(TrianglePart::kFace), moving(number(i)));
        for (std::size_t j = 0; j < 3; ++j) {
          add(inner_distance(p, i, q, j), fixed(number(3 + i)), moving(number(3 + j)));
        }
      }
    }
  }
  return found;
}

// The middle of a fan is farther from the plate than all triangles of the fan. Its slopes are
// within the tolerance.
TEST(FeatureList, HasAMinimumThatNearlyTies) {
  TriangleMesh fan;
  constexpr std::uint32_t kRim = 8;
  constexpr double kHeight = 0.01, kGap = 0.005;
  fan.vertices.emplace_back(0, 0, kHeight);
  for (std::uint32_t k = 0; k < kRim; ++k) {
    const double at = 2 * std::numbers::pi * k / kRim;
    fan.vertices.emplace_back(std::cos(at), std::sin(at), 0);
    fan.triangles.push_back({0, 1 + k, 1 + (k + 1) % kRim});
  }
  FeatureBodies bodies(fine_box({6, 6, 1}, 21), fan);
  const auto middle_is_listed = [&](double tolerance) {
    std::vector<NearPair> near(1 << 12);
    const Eigen::Isometry3d pose = shift({0.05, 0.02, 0.5 + kGap});
    near.resize(bodies.query.near_pairs(pose, 0.03, near).near_pairs);
    FeatureList features(bodies.fixed.surface, bodies.moving.surface, 1 << 12);
    features.find(near, pose, 0.03, Which::kMinima, tolerance);
    return std::any_of(
        features.features().begin(), features.features().end(), [&](const Feature& f) {
          return f.moving == SurfacePart{Kind::kVertex, 0} && f.fixed.kind == Kind::kFace &&
                 std::abs(f.gap - kGap - kHeight) <= kLengthRounding;
        });
  };
  EXPECT_TRUE(middle_is_listed(FeatureList::kTolerance));
  EXPECT_TRUE(middle_is_listed(1.001 * kHeight));
  EXPECT_FALSE(middle_is_listed(0.9 * kHeight));
}

TEST(FeatureList, HasAllFeaturesOnce) {
  Random random(2);
  std::size_t features = 0, minima = 0;
  for (int i = 0; i < samples(60) && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const TriangleMesh meshes[] = {icosphere(1, 1), torus(1, 0.5, 7, 6), fine_box({1, 2, 1.5}, 2),
                                   cylinder(2, 0.7, 1)};
    FeatureBodies bodies(meshes[random.below(4u)], meshes[random.below(4u)]);
    // Comes from far until it is near.
    Eigen::Isometry3d pose = pose_of(random.rotation(), 4 * random.direction());
    const Vector way = -pose.translation().normalized();
    const double margin = 0.3, wanted = random.uniform(0.001, 0.2);
    for (int k = 0; k < 30; ++k) {
      const double apart = bodies.query.distance(pose, 0).distance.upper;
      if (apart <= wanted + 1e-3) break;
      pose.translation() += (apart - wanted) * way;
    }
    const double distance = bodies.query.distance(pose, 0).distance.upper;
    if (!(distance > 0 && distance < margin)) continue;  // it passes by

    std::map<Parts, Feature> listed;
    double least = HUGE_VAL;
    const std::vector<Feature> all = bodies.list(pose, margin, Which::kAll);
    for (const Feature& f : all) {
      EXPECT_TRUE(listed.emplace(parts_of(f), f).second);
      EXPECT_LE(f.gap, margin + kLengthRounding);
      EXPECT_NEAR(f.normal.norm(), 1, 1e-12);
      EXPECT_LE((f.fixed_point + f.gap * f.normal - f.moving_point).norm(), kLengthRounding);
      least = std::min(least, f.gap);
    }
    EXPECT_NEAR(least, distance, 1e-7);
    for (const auto& [parts, gap] : brute_features(bodies, pose, margin)) {
      const auto at = listed.find(parts);
      ASSERT_NE(at, listed.end());
      EXPECT_NEAR(at->second.gap, gap, kLengthRounding);
    }
    // The minima are those that leave both surfaces and are not inside plane regions.
    std::map<Parts, double> few;
    for (const Feature& f : bodies.list(pose, margin, Which::kMinima)) {
      EXPECT_TRUE(few.emplace(parts_of(f), f.gap).second);
      const auto at = listed.find(parts_of(f));
      ASSERT_NE(at, listed.end());
      EXPECT_NEAR(f.gap, at->second.gap, kLengthRounding);
    }
    for (const auto& [parts, f] : listed) {
      const Vector back = -(pose.linear().transpose() * f.normal);
      const bool is_flat =
          bodies.fixed.surface.is_flat(f.fixed) || bodies.moving.surface.is_flat(f.moving);
      const auto leaves = [&](double tolerance) {
        return bodies.fixed.surface.leaves(f.fixed, f.normal, tolerance) &&
               bodies.moving.surface.leaves(f.moving, back, tolerance);
      };
      if (few.contains(parts)) {
        EXPECT_TRUE(leaves(is_flat ? 2e-6 : FeatureList::kTolerance + 1e-9));
      } else {
        EXPECT_TRUE(is_flat || !leaves(0));
      }
    }
    EXPECT_GE(few.size(), 1u);
    features += all.size();
    minima += few.size();
  }
  EXPECT_GT(features, samples(500u));
  EXPECT_LT(minima, features / 2);
}

TEST(FeatureList, IsThinnedToTheNearestOfEachCell) {
  FeatureBodies bodies(icosphere(4, 1.01), icosphere(4, 1));
  const Eigen::Isometry3d pose = pose_of(Random(3).rotation(), {0.002, 0.003, 0.001});
  const std::vector<Feature> all = bodies.list(pose, 0.02, Which::kAll, 1 << 16);
  ASSERT_GT(all.size(), 5'000u);
  for (const std::size_t room : {1u, 10u, 100u, 500u}) {
    const std::vector<Feature> some = bodies.list(pose, 0.02, Which::kAll, room, true);
    EXPECT_EQ(some.size(), room);
    EXPECT_EQ(parts_of(some[0]), parts_of(all[0]));
    std::map<Parts, double> listed;
    for (const Feature& f : some) EXPECT_TRUE(listed.emplace(parts_of(f), f.gap).second);
    for (const Feature& f : all) listed.erase(parts_of(f));
    EXPECT_TRUE(listed.empty());
  }
  FeatureList none(bodies.fixed.surface, bodies.moving.surface, 10);
  none.find({}, pose, 0.02, Which::kAll);
  EXPECT_TRUE(none.features().empty());
  EXPECT_FALSE(none.is_thinned());
}

}  // namespace
}  // namespace ist::test
