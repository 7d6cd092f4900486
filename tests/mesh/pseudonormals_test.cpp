#include "ist/mesh/pseudonormals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/shapes.h"

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

}  // namespace
}  // namespace ist::test
