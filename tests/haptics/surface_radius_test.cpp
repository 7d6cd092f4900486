#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ist/haptics/tool.h"
#include "ist/models/models.h"
#include "ist/tree/sphere_tree.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// A triangle is nowhere farther away than at a corner.
double farthest_vertex(const TriangleMesh& mesh, const Eigen::Vector3d& origin) {
  double farthest = 0;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    farthest = std::max(farthest, (vertex - origin).norm());
  }
  return farthest;
}

void expect_radius_of(const TriangleMesh& mesh, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = SpherePolicy::kSimple;
  const SphereTree tree = build_tree(mesh, options);
  const double farthest = farthest_vertex(mesh, tree.origin());
  const double radius = surface_radius(tree);
  EXPECT_GE(radius, farthest) << voxel_size;
  EXPECT_LE(radius, (farthest + 2 * std::sqrt(3.0) * voxel_size) * (1 + 1e-8)) << voxel_size;
}

TEST(SurfaceRadius, HoldsAllVerticesAndNotMuchMore) {
  Random random(11);
  for (int i = 0; i < samples(60); ++i) {
    const TriangleMesh mesh = turned(
        moved(icosphere(1, random.uniform(0.1, 5)), random.point(-20, 20)), random.rotation());
    expect_radius_of(mesh, random.uniform(0.02, 6));
    expect_radius_of(open_strip(1 + i % 60), random.uniform(0.05, 4));
  }
  expect_radius_of(make_jaw(Jaw::kLower, 1), 1);
}

TEST(SurfaceRadius, OfASingleVoxelHoldsItToo) {
  expect_radius_of(box({3, 3, 3}, {4, 4, 4}), 1);
  expect_radius_of(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 50);
}

}  // namespace
}  // namespace ist::test
