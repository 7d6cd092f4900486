#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "query/triangles/mesh_distance.h"

namespace ist::test {
namespace {

void expect_sound(const TriangleMesh& mesh, std::size_t triangles) {
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.triangles, triangles);
  EXPECT_EQ(report.vertices, 2 + triangles / 2) << "not of genus 0";
  EXPECT_TRUE(report.closed && report.consistent);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.degenerate_triangles, 0u);
  EXPECT_GT(report.signed_volume, 0);
}

TEST(ShapeModel, MakesABoxBetweenItsCorners) {
  const TriangleMesh mesh = make_box({-1, 0, 2}, {1, 4, 3});
  expect_sound(mesh, 12);
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.box_min, Eigen::Vector3d(-1, 0, 2));
  EXPECT_EQ(report.box_max, Eigen::Vector3d(1, 4, 3));
  EXPECT_NEAR(report.signed_volume, 8, 1e-14);
}

TEST(ShapeModel, MakesSpheresWithEdgesAsShortAsIsGuaranteed) {
  std::size_t triangles = 20;
  for (int level = 0; level <= 5; ++level, triangles *= 4) {
    const TriangleMesh mesh = make_icosphere(level, 3);
    expect_sound(mesh, triangles);
    for (const Eigen::Vector3d& vertex : mesh.vertices) EXPECT_NEAR(vertex.norm(), 3, 1e-14);
    const double edge = longest_edge(mesh) * std::pow(2, level) / 3;
    EXPECT_LT(edge, 1.33) << level;
    EXPECT_GT(edge, 1.05) << level;
  }
}

TEST(ShapeModel, MakesCylindersFromZeroUp) {
  for (const int quarter : {1, 2, 16}) {
    const TriangleMesh mesh = make_cylinder(quarter, 2, 5);
    expect_sound(mesh, static_cast<std::size_t>(16 * quarter));
    const MeshReport report = check_mesh(mesh);
    EXPECT_EQ(report.box_min, Eigen::Vector3d(-2, -2, 0));
    EXPECT_EQ(report.box_max, Eigen::Vector3d(2, 2, 5));
    // Between the cylinder's and that of the smallest angle between neighbours' inner circle.
    EXPECT_LE(report.signed_volume, M_PI * 4 * 5);
    EXPECT_GE(report.signed_volume, M_PI * 4 * 5 * std::pow(std::cos(1.0 / quarter), 2));
  }
}

TEST(ShapeModel, MakesAFossaOfTwoHalfSpheres) {
  for (const int quarter : {1, 2, 16, 32}) {
    const TriangleMesh mesh = make_fossa(quarter, 3, 1);
    expect_sound(mesh, static_cast<std::size_t>(16 * quarter * quarter));
    const MeshReport report = check_mesh(mesh);
    EXPECT_EQ(report.box_min, Eigen::Vector3d(-4, -4, 0)) << "the rim is not at z = 0";
    EXPECT_EQ(report.box_max, Eigen::Vector3d(4, 4, 4));
    std::size_t inner = 0;
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      inner += vertex.norm() < 3.5 ? 1u : 0u;
      EXPECT_NEAR(vertex.norm(), vertex.norm() < 3.5 ? 3 : 4, 1e-14);
    }
    EXPECT_EQ(2 * inner, mesh.vertices.size());
    const double hollow = 2 * M_PI / 3 * (4 * 4 * 4 - 3 * 3 * 3);
    EXPECT_NEAR(report.signed_volume, hollow, 2 * hollow / (quarter * quarter));
  }
}

TEST(ShapeModel, MakesAFossaWhoseTrianglesAreAsCloseToTheirSpheresAsIsGuaranteed) {
  for (const int quarter : {2, 16, 32}) {
    const TriangleMesh mesh = make_fossa(quarter, 1, 1);
    double deepest = 0;
    for (const auto& [i, j, k] : mesh.triangles) {
      const Eigen::Vector3d &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
      if (a.z() == 0 && b.z() == 0 && c.z() == 0) continue;
      // The plane's point nearest to the origin lies in the triangle or deeper than all of it.
      const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
      deepest = std::max(deepest, 1 - std::abs(normal.dot(a)) / a.norm());
    }
    EXPECT_LT(deepest, 1.0 / (quarter * quarter));
    EXPECT_GT(deepest, 0.5 / (quarter * quarter)) << "the promise may be sharper";
  }
}

}  // namespace
}  // namespace ist::test
