// Tight spheres against their payload in exact arithmetic: the triangles of the node, clipped to
// its grown cube.

#include "ist/tree/tight_spheres.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include "ist/base/parallel.h"
#include "ist/voxel/voxelizer.h"
#include "support/exact.h"
#include "support/seeded.h"
#include "support/shapes.h"

namespace ist {
namespace {

using Eigen::Vector3d;

struct Built {
  VoxelSet voxels;
  LinearOctree octree;
  SphereLevels levels;
};

Built build(const TriangleMesh& mesh, double voxel_size) {
  VoxelSet voxels = voxelize(mesh, {voxel_size, true});
  LinearOctree octree(voxels.codes, voxels.lattice.depth);
  SphereLevels levels = make_tight_spheres(mesh, voxels, octree);
  return {std::move(voxels), std::move(octree), std::move(levels)};
}

// The payload of a node from its definition: the triangles that its leaves list, clipped.
std::vector<test::ExactPoint> payload(const TriangleMesh& mesh, const VoxelSet& voxels, int level,
                                      std::uint64_t code) {
  std::set<std::uint32_t> triangles;
  for (std::size_t leaf = 0; leaf < voxels.codes.size(); ++leaf) {
    if (voxels.codes[leaf] >> 3 * level != code) continue;
    triangles.insert(voxels.triangles[leaf].begin(), voxels.triangles[leaf].end());
  }
  const test::ExactBox cube =
      test::grown(test::node_cube(voxels.lattice, level, code), test::exact_pad(voxels.lattice));
  std::vector<test::ExactPoint> points;
  for (const std::uint32_t t : triangles) {
    const test::ExactPolygon piece = test::clip(test::exact_triangle(mesh, t), cube);
    points.insert(points.end(), piece.begin(), piece.end());
  }
  return points;
}

void expect_tight_spheres(const TriangleMesh& mesh, double voxel_size) {
  const Built built = build(mesh, voxel_size);
  const Lattice& lattice = built.voxels.lattice;
  ASSERT_EQ(built.levels.size(), static_cast<std::size_t>(lattice.depth) + 1);
  const test::ExactPoint origin = test::frame_origin(lattice);
  // A centre that becomes float moves by half a unit in the last place on each axis.
  const double moved = 0x1p-24 * std::sqrt(3.0) * lattice.edge(lattice.depth);
  for (int level = 0; level <= lattice.depth; ++level) {
    const std::vector<std::uint64_t> codes = built.octree.codes(level);
    const std::vector<Sphere>& spheres = built.levels[static_cast<std::size_t>(level)];
    ASSERT_EQ(spheres.size(), codes.size());
    for (std::size_t node = 0; node < codes.size(); ++node) {
      const Sphere& sphere = spheres[node];
      const test::ExactPoint centre = origin + test::exact(Vector3d(sphere.x, sphere.y, sphere.z));
      const mpq_class radius(sphere.r);
      const std::vector<test::ExactPoint> points = payload(mesh, built.voxels, level, codes[node]);
      ASSERT_FALSE(points.empty()) << "a node without a surface point";
      for (const test::ExactPoint& p : points) {
        ASSERT_LE(test::square(p - centre), radius * radius) << level << ' ' << node;
      }
      const double smallest = std::sqrt(test::smallest_ball(points).radius_squared.get_d());
      ASSERT_LE(double{sphere.r}, 1.01 * smallest + 2 * moved) << level << ' ' << node;
    }
  }
}

TEST(TightSpheres, OfASphere) { expect_tight_spheres(test::icosphere(2, 1), 0.21); }

TEST(TightSpheres, OfABoxOnThePlanesOfTheGrid) {
  expect_tight_spheres(test::box({0, 0, 0}, {5, 3, 2}), 1);
  expect_tight_spheres(test::box({0.1, 0.2, 0.3}, {0.9, 0.6, 0.5}), 0.1);
}

TEST(TightSpheres, OfRandomTrianglesSliversSegmentsAndPoints) {
  test::Seeded seeded(1);
  TriangleMesh mesh;
  for (int i = 0; i < 12; ++i) {
    const Vector3d a = seeded.point(-1, 1), b = seeded.point(-1, 1), c = seeded.point(-1, 1);
    const Vector3d between = a + seeded.between(0, 1) * (b - a);
    const Vector3d third[] = {c, between, between + 1e-6 * c, a};
    mesh = test::joined(mesh, test::triangle(a, i % 6 == 5 ? a : b, third[i % 4]));
  }
  expect_tight_spheres(mesh, 0.23);
}

TEST(TightSpheres, FarFromTheOrigin) {
  expect_tight_spheres(test::moved(test::icosphere(1, 1), {1e6, -1e6, 1e6}), 0.21);
}

TEST(TightSpheres, OfOneVoxel) { expect_tight_spheres(test::icosphere(1, 1), 7); }

// Small triangles in large nodes, and large triangles in small ones.
TEST(TightSpheres, OfTrianglesMuchSmallerAndMuchLargerThanVoxels) {
  const TriangleMesh small = test::moved(test::icosphere(2, 0.05), {2, 2, 2});
  expect_tight_spheres(test::joined(small, test::triangle({0, 0, 0}, {3, 0.3, 1}, {1, 3, 2.9})),
                       0.4);
}

TEST(TightSpheres, AreTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = test::icosphere(3, 1);
  const auto of_threads = [&](std::size_t threads) {
    const ScopedThreadLimit limit(threads);
    return build(mesh, 0.05).levels;
  };
  const SphereLevels one = of_threads(1), two = of_threads(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t level = 0; level < one.size(); ++level) {
    ASSERT_EQ(one[level].size(), two[level].size());
    EXPECT_EQ(std::memcmp(one[level].data(), two[level].data(), one[level].size() * sizeof(Sphere)),
              0);
  }
}

}  // namespace
}  // namespace ist
