#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "ist/mesh/nearest_point.h"
#include "ist/mesh/pseudonormals.h"
#include "ist/mesh/winding_number.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;
using test::exact;

double exact_distance(const Eigen::Vector3d& p, const test::ExactPolygon& piece) {
  return std::sqrt(test::distance_squared(exact(p), piece).get_d());
}

// The point is on the triangle, on the feature that is named, and no other is nearer.
void expect_nearest(const Corners& triangle, const Eigen::Vector3d& from, double tolerance) {
  const NearestPoint nearest = nearest_on_triangle(triangle, from);
  ASSERT_TRUE(nearest.point.allFinite());
  const test::ExactPolygon piece = test::exact_triangle(triangle);
  EXPECT_LE(exact_distance(nearest.point, piece), tolerance);
  EXPECT_NEAR((from - nearest.point).norm(), exact_distance(from, piece), tolerance);
  ASSERT_GE(nearest.feature, 0);
  ASSERT_LE(nearest.feature, NearestPoint::kInside);
  if (nearest.feature == NearestPoint::kInside) return;
  const auto i = static_cast<std::size_t>(nearest.feature % 3);
  if (nearest.feature < 3) {
    EXPECT_EQ(nearest.point, triangle[i]);
  } else {
    const Eigen::Vector3d &a = triangle[i], &b = triangle[(i + 1) % 3];
    EXPECT_LE(exact_distance(nearest.point, test::exact_triangle({a, b, b})), tolerance);
  }
}

TEST(NearestOnTriangle, IsAsNearAsTheExactNearestPoint) {
  test::Random random(1);
  for (int i = 0; i < test::samples(5000); ++i) {
    const Corners triangle{random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)};
    expect_nearest(triangle, random.point(-2, 2), 1e-12);
  }
}

TEST(NearestOnTriangle, IsRightWherePointsLieOnCornersEdgesAndAboveThem) {
  test::Random random(2);
  for (int i = 0; i < test::samples(5000); ++i) {
    const Corners triangle{random.point_on_grid(-2, 2, 1), random.point_on_grid(-2, 2, 1),
                           random.point_on_grid(-2, 2, 1)};  // many of them degenerate
    expect_nearest(triangle, random.point_on_grid(-3, 3, 0.5), 1e-13);
  }
}

TEST(NearestOnTriangle, NamesTheFeature) {
  const Corners triangle{Eigen::Vector3d(0, 0, 0), {4, 0, 0}, {0, 4, 0}};
  const auto feature = [&](double x, double y) {
    return nearest_on_triangle(triangle, {x, y, 1}).feature;
  };
  EXPECT_EQ(feature(-1, -1), 0);
  EXPECT_EQ(feature(6, -1), 1);
  EXPECT_EQ(feature(-1, 6), 2);
  EXPECT_EQ(feature(2, -1), 3);
  EXPECT_EQ(feature(3, 3), 4);
  EXPECT_EQ(feature(-1, 2), 5);
  EXPECT_EQ(feature(1, 1), NearestPoint::kInside);
}

TEST(NearestOnTriangle, OfASegmentOrAPointIsThatOfTheSegmentOrThePoint) {
  test::Random random(3);
  for (int i = 0; i < test::samples(3000); ++i) {
    const Eigen::Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
    const Eigen::Vector3d from = random.point(-2, 2);
    expect_nearest({a, a, a}, from, 1e-15);
    expect_nearest({a, a, b}, from, 1e-13);
    expect_nearest({a, b, a}, from, 1e-13);
    expect_nearest({a, b, b}, from, 1e-13);
  }
}

// The three corners on a line but for rounding, in any order.
TEST(NearestOnTriangle, OfANeedleIsNearlyThatOfTheSegment) {
  test::Random random(4);
  for (int i = 0; i < test::samples(5000); ++i) {
    const Eigen::Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
    const Eigen::Vector3d between = a + random.uniform(0, 1) * (b - a);
    const Eigen::Vector3d from = random.point(-2, 2);
    expect_nearest({a, b, between}, from, 1e-7);
    expect_nearest({between, a, b}, from, 1e-7);
    expect_nearest({b, between, a}, from, 1e-7);
  }
}

TEST(NearestOnTriangle, OfASliverIsRightToAPartOfItsWidth) {
  test::Random random(5);
  for (int i = 0; i < test::samples(3000); ++i) {
    const Eigen::Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
    const Eigen::Vector3d c = a + random.uniform(0, 1) * (b - a) + 1e-6 * random.direction();
    expect_nearest({a, b, c}, random.point(-2, 2), 1e-9);
  }
}

// Points that are as near to the sliver as it is wide, and farther: the foot matters there.
TEST(NearestOnTriangle, OfAThinSliverIsAsNearAsTheExactNearestPoint) {
  test::Random random(6);
  for (int i = 0; i < test::samples(6000); ++i) {
    const double wide = std::pow(0.1, random.uniform(2, 8));
    Eigen::Vector3d at[3] = {random.point(-1, 1), random.point(-1, 1), {}};
    at[2] = at[0] + random.uniform(0, 1) * (at[1] - at[0]) + wide * random.direction();
    const Corners triangle = {at[i % 3], at[(i + 1) % 3], at[(i + 2) % 3]};
    const double u = random.uniform(0, 1), v = random.uniform(0, 1);
    const Eigen::Vector3d on = at[0] + std::min(u, v) * (at[1] - at[0]) +
                               (std::max(u, v) - std::min(u, v)) * (at[2] - at[0]);
    const double off = wide * std::pow(10.0, random.uniform(-2, 3));
    expect_nearest(triangle, on + off * random.direction(), 2e-15);
  }
}

}  // namespace
}  // namespace ist

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;

// The normal at the point of a mesh nearest to `point`, by a look at all triangles.
std::optional<Vector> normal_near(const TriangleMesh& mesh, const Vector& point) {
  std::uint32_t nearest = 0;
  NearestPoint on{};
  double least = HUGE_VAL;
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
    const Triangle& t = mesh.triangles[k];
    const auto& v = mesh.vertices;
    const NearestPoint here = nearest_on_triangle({v[t[0]], v[t[1]], v[t[2]]}, point);
    if ((here.point - point).squaredNorm() >= least) continue;
    least = (here.point - point).squaredNorm();
    nearest = k;
    on = here;
  }
  return Pseudonormals(mesh).at(mesh, nearest, on);
}

double along(const TriangleMesh& mesh, const Vector& point, const Vector& direction) {
  const auto normal = normal_near(mesh, point);
  EXPECT_TRUE(normal.has_value());
  return normal.value_or(Vector::Zero()).normalized().dot(direction.normalized());
}

TEST(Pseudonormals, OfABoxPointOutOfItsFacesEdgesAndCorners) {
  const TriangleMesh mesh = box({0, 0, 0}, {1, 2, 3});
  EXPECT_TRUE(Pseudonormals(mesh).closed());
  EXPECT_NEAR(along(mesh, {2, 0.7, 1.1}, {1, 0, 0}), 1, 1e-12);
  EXPECT_NEAR(along(mesh, {2, 3, 1.1}, {1, 1, 0}), 1, 1e-12);
  // However a corner's three squares are cut into triangles, each counts by its right angle.
  for (const Vector& corner : {Vector(-1, -1, -1), Vector(2, 3, 4), Vector(2, -1, -1),
                               Vector(-1, 3, -1), Vector(-1, -1, 4), Vector(2, 3, -1)}) {
    const Vector out = corner.unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
    EXPECT_NEAR(along(mesh, corner, out), 1, 1e-12) << corner.transpose();
  }
}

// A pyramid's apex over a base of many narrow triangles on one side: a sum of normals that does
// not weigh by angles leans to that side, so far that points in front of the other would be inside.
TEST(Pseudonormals, WeighByAngles) {
  TriangleMesh mesh;
  const int fan = 40;
  mesh.vertices = {{0, 0, 1}};
  for (int i = 0; i <= fan; ++i) mesh.vertices.emplace_back(1, -1 + 2.0 * i / fan, 0);
  mesh.vertices.emplace_back(-1, 1, 0);
  mesh.vertices.emplace_back(-1, -1, 0);
  const auto ring = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t i = 1; i <= ring; ++i) {
    const std::uint32_t next = i == ring ? 1 : i + 1;
    mesh.triangles.push_back({0, i, next});
    if (i > 1 && i < ring) mesh.triangles.push_back({1, i + 1, i});
  }
  const Pseudonormals normals(mesh);
  ASSERT_TRUE(normals.closed());
  EXPECT_NEAR(along(mesh, {0, 0, 2}, {0, 0, 1}), 1, 1e-12);
}

TEST(Pseudonormals, AreUnknownAtAnOpenBorder) {
  const TriangleMesh strip = open_strip(2);
  EXPECT_FALSE(Pseudonormals(strip).closed());
  EXPECT_TRUE(normal_near(strip, {0.7, 0.4, 1}).has_value());
  EXPECT_TRUE(normal_near(strip, {1, 0.5, 1}).has_value()) << "on an edge inside";
  EXPECT_FALSE(normal_near(strip, {0.7, -1, 1}).has_value());
  EXPECT_FALSE(normal_near(strip, {-1, -1, 0}).has_value());
}

TEST(Pseudonormals, AreUnknownWhereNeighboursDisagreeOrAreThree) {
  TriangleMesh turned = box({0, 0, 0}, {1, 1, 1});
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_FALSE(Pseudonormals(turned).closed());
  TriangleMesh fin = box({0, 0, 0}, {1, 1, 1});
  fin.vertices.emplace_back(2, 2, 2);
  fin.triangles.push_back({fin.triangles[0][0], fin.triangles[0][1], 8});
  EXPECT_FALSE(Pseudonormals(fin).closed());
  EXPECT_FALSE(Pseudonormals(fin).at(fin, 0, {fin.vertices[fin.triangles[0][0]], 0}).has_value());
}

// A corner on the edge of a neighbour: between them a triangle without an area.
TEST(Pseudonormals, LookOverTrianglesWithoutAnArea) {
  TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  // The triangles of one edge: one is cut in two at the edge's middle, and the gap is filled.
  const std::uint32_t from = mesh.triangles[0][0], to = mesh.triangles[0][1];
  const std::uint32_t third = mesh.triangles[0][2];
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(0.5 * (mesh.vertices[from] + mesh.vertices[to]));
  mesh.triangles[0] = {from, middle, third};
  mesh.triangles.push_back({middle, to, third});
  mesh.triangles.push_back({from, to, middle});
  const Pseudonormals normals(mesh);
  ASSERT_TRUE(normals.closed());
  for (const double part : {0.1, 0.4, 0.6, 0.9}) {
    const Vector on = mesh.vertices[from] + part * (mesh.vertices[to] - mesh.vertices[from]);
    const Vector out = on - Vector(0.5, 0.5, 0.5);
    for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
      const Triangle& t = mesh.triangles[k];
      const auto& v = mesh.vertices;
      const NearestPoint here = nearest_on_triangle({v[t[0]], v[t[1]], v[t[2]]}, on + 0.1 * out);
      if ((here.point - on).norm() > 0.1) continue;
      const auto normal = normals.at(mesh, k, here);
      ASSERT_TRUE(normal.has_value()) << part << ' ' << k;
      EXPECT_GT(normal->dot(out), 0) << part << ' ' << k;
    }
  }
}

struct Rays {
  explicit Rays(TriangleMesh of)
      : mesh(std::move(of)), clusters(mesh, mesh.vertices[mesh.triangles[0][0]]) {}
  [[nodiscard]] std::optional<int> at(const Vector& p) const {
    return WindingNumber(mesh, clusters).at(p);
  }
  TriangleMesh mesh;
  TriangleClusters clusters;
};

std::vector<TriangleMesh> closed_meshes() {
  return {icosphere(3, 4),
          box({0, 0, 0}, {4, 4, 4}),
          torus(5, 2, 24, 12),
          plate_with_holes(3),
          joined(icosphere(2, 4), inside_out(icosphere(2, 2))),
          joined(icosphere(2, 4), icosphere(2, 2)),
          joined(box({0, 0, 0}, {4, 4, 4}), box({2, 2, 2}, {6, 6, 6})),
          joined(box({0, 0, 0}, {2, 2, 2}), box({2, 0, 0}, {4, 2, 2})),
          inside_out(pipe(6, 2, 3, 8))};
}

TEST(WindingNumber, EqualsTheSumOfSolidAngles) {
  Random random(1);
  for (const TriangleMesh& mesh : closed_meshes()) {
    const Rays rays(mesh);
    for (int k = 0; k < samples(400); ++k) {
      const Vector p(random.uniform(-7, 7), random.uniform(-7, 7), random.uniform(-7, 7));
      EXPECT_EQ(rays.at(p), std::lround(winding_by_angles(mesh, p))) << p.transpose();
    }
  }
}

// The ray then passes through vertices and along edges and faces.
TEST(WindingNumber, IsExactIfThePointIsLevelWithVertices) {
  Random random(2);
  int measured = 0;
  for (const TriangleMesh& mesh : closed_meshes()) {
    const Rays rays(mesh);
    const auto level = [&](Eigen::Index axis) {
      const auto& v = mesh.vertices;
      return v[random.below(v.size())][axis];
    };
    for (int k = 0; k < samples(400); ++k) {
      const Vector p(random.uniform(-7, 7), level(1), level(2));
      const std::optional<int> winding = rays.at(p);
      const double expected = winding_by_angles(mesh, p);
      if (!winding) continue;
      if (std::abs(expected - std::round(expected)) > 1e-6) continue;  // very near the surface
      EXPECT_EQ(*winding, std::lround(expected)) << p.transpose();
      ++measured;
    }
  }
  EXPECT_GT(measured, samples(9 * 400) * 3 / 4);
}

TEST(WindingNumber, IsNoNumberOnTheSurface) {
  for (const TriangleMesh& mesh : closed_meshes()) {
    const Rays rays(mesh);
    for (std::size_t k = 0; k < mesh.vertices.size(); k += 7) {
      EXPECT_EQ(rays.at(mesh.vertices[k]), std::nullopt);
    }
  }
  const Rays cube(box({0, 0, 0}, {4, 4, 4}));
  for (const Vector& p : {Vector(2, 2, 0), Vector(0, 2, 2), Vector(1, 3, 4), Vector(4, 4, 1)}) {
    EXPECT_EQ(cube.at(p), std::nullopt) << p.transpose();
  }
  EXPECT_EQ(cube.at({2, 2, std::nextafter(0, 1)}), 1);
  EXPECT_EQ(cube.at({2, 2, std::nextafter(0, -1)}), 0);
  EXPECT_EQ(cube.at({std::nextafter(4, 3), 2, 2}), 1);
  EXPECT_EQ(cube.at({std::nextafter(4, 5), 2, 2}), 0);
}

TEST(WindingNumber, HoldsAtAnyScaleAndPlace) {
  Random random(3);
  for (const double scale : {1e-12, 1e-9, 1.0, 1e15}) {
    for (const double place : {0.0, 1e6}) {
      TriangleMesh mesh = moved(torus(5, 2, 24, 12), {place, -place, place});
      for (Vector& v : mesh.vertices) v *= scale;
      const Rays rays(mesh);
      for (int k = 0; k < samples(200); ++k) {
        const Vector p(random.uniform(-7, 7), random.uniform(-7, 7), random.uniform(-2, 2));
        const double ring = std::hypot(p[0], p[1]) - 5, tube = std::hypot(ring, p[2]);
        if (std::abs(tube - 2) < 0.1) continue;
        EXPECT_EQ(rays.at(scale * (p + Vector(place, -place, place))), tube < 2 ? 1 : 0);
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
