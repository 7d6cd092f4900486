// Voxels and triangle lists against exact arithmetic, both ways: each closed cube that a triangle
// meets is found, and none is that a triangle misses by more than the pad.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "ist/voxel/voxelizer.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist {
namespace {

using Eigen::Vector3d;
using Codes = std::vector<std::uint64_t>;

bool includes(const Codes& all, const Codes& some) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

// The codes that list each triangle.
std::vector<Codes> codes_by_triangle(const VoxelSet& set, std::size_t triangles) {
  std::vector<Codes> codes(triangles);
  for (std::size_t voxel = 0; voxel < set.codes.size(); ++voxel) {
    const auto ids = set.triangles[voxel];
    EXPECT_FALSE(ids.empty()) << "a voxel that no triangle meets";
    EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end(), std::less_equal<>()) || ids.size() == 1);
    for (const std::uint32_t id : ids) codes[id].push_back(set.codes[voxel]);
  }
  return codes;
}

VoxelSet expect_exactly_the_voxels(const TriangleMesh& mesh, double voxel_size) {
  const VoxelSet set = voxelize(mesh, {voxel_size, true});
  EXPECT_EQ(set.triangles.size(), set.codes.size());
  EXPECT_EQ(set.normals.size(), set.codes.size());
  EXPECT_EQ(std::adjacent_find(set.codes.begin(), set.codes.end(), std::greater_equal<>()),
            set.codes.end())
      << "codes ascend";
  const std::vector<Codes> found = codes_by_triangle(set, mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const test::ExactPolygon triangle = test::exact_triangle(mesh, t);
    EXPECT_TRUE(includes(found[t], test::cells_met(triangle, set.lattice, 0)))
        << "triangle " << t << " meets a cube that does not list it";
    EXPECT_TRUE(
        includes(test::cells_met(triangle, set.lattice, test::exact_pad(set.lattice)), found[t]))
        << "triangle " << t << " misses a grown cube that lists it";
  }
  return set;
}

void add(TriangleMesh& mesh, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  mesh = test::joined(mesh, test::triangle(a, b, c));
}

TriangleMesh random_triangles(std::uint64_t seed, int count) {
  test::Random random(seed);
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vector3d at = random.point(-1, 1);
    const double size = i % 5 == 0 ? 2 : 0.4;
    add(mesh, at, at + size * random.point(-1, 1), at + size * random.point(-1, 1));
  }
  return mesh;
}

TEST(VoxelizerExact, RandomTriangles) {
  for (std::uint64_t seed = 1; seed <= test::samples(std::uint64_t{4}); ++seed) {
    expect_exactly_the_voxels(random_triangles(seed, 40), 0.13);
    expect_exactly_the_voxels(random_triangles(seed, 10), 0.05);
  }
}

TEST(VoxelizerExact, LongSlivers) {
  test::Random random(1);
  TriangleMesh mesh;
  for (int i = 0; i < test::samples(60); ++i) {
    const Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
    add(mesh, a, b, a + random.uniform(0, 1) * (b - a) + 1e-6 * random.direction());
    add(mesh, a, b, a + 1e-6 * random.direction());
  }
  expect_exactly_the_voxels(mesh, 0.07);
}

TEST(VoxelizerExact, PointsSegmentsAndNeedles) {
  test::Random random(2);
  TriangleMesh mesh;
  for (int i = 0; i < test::samples(60); ++i) {
    const Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
    add(mesh, a, a, a);
    add(mesh, a, b, b);
    add(mesh, a, b, a);
    add(mesh, a, b, a + random.uniform(0, 1) * (b - a));
  }
  expect_exactly_the_voxels(mesh, 0.09);
}

// Corners and faces on the planes of the grid, where closed cubes on both sides count.
TEST(VoxelizerExact, CornersOnThePlanesOfTheGrid) {
  test::Random random(3);
  for (const double size : {1.0, 0.1, 0.7}) {
    TriangleMesh mesh = test::triangle({0, 0, 0}, {8 * size, 0, 0}, {0, 8 * size, 8 * size});
    for (int i = 0; i < test::samples(60); ++i) {
      const auto corner = [&] { return Vector3d(size * random.point_on_grid(0, 9, 1)); };
      const Vector3d a = corner(), b = corner(), c = corner();
      add(mesh, a, b, c);
    }
    expect_exactly_the_voxels(mesh, size);
  }
}

TEST(VoxelizerExact, BoxesOnThePlanesOfTheGrid) {
  for (const double size : {1.0, 0.1, 0.3, 1.0 / 3, 0.2}) {
    const auto corner = [size](int x, int y, int z) {
      return Vector3d(x * size, y * size, z * size);
    };
    const TriangleMesh mesh = test::joined(test::box(corner(0, 0, 0), corner(7, 5, 3)),
                                           test::box(corner(2, 1, 1), corner(5, 4, 2)));
    expect_exactly_the_voxels(mesh, size);
  }
}

// The voxelizer works in blocks of 16³ voxels: planes of the grid that part blocks are special.
TEST(VoxelizerExact, BoxesOnThePlanesBetweenBlocks) {
  for (const double size : {1.0, 0.1, 1.0 / 3, 0.7}) {
    const auto corner = [size](int x, int y, int z) {
      return Vector3d(x * size, y * size, z * size);
    };
    TriangleMesh mesh = test::box(corner(0, 0, 0), corner(50, 48, 2));
    for (const int plane : {16, 32, 48}) {
      mesh = test::joined(mesh, test::box(corner(plane, 1, 1), corner(plane + 1, 5, plane)));
      mesh = test::joined(mesh, test::box(corner(1, plane - 3, 1), corner(4, plane, 16)));
    }
    expect_exactly_the_voxels(mesh, size);
  }
}

TEST(VoxelizerExact, AFaceOnAPlaneOfTheGridOccupiesBothSides) {
  TriangleMesh mesh = test::triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
  add(mesh, {4, 4, 4}, {4, 4, 4}, {4, 4, 4});
  add(mesh, {1.5, 1.5, 2}, {2.5, 1.5, 2}, {1.5, 2.5, 2});
  const VoxelSet set = expect_exactly_the_voxels(mesh, 1);
  for (std::uint32_t x = 1; x < 3; ++x) {
    for (std::uint32_t y = 1; y < 3; ++y) {
      for (std::uint32_t z = 1; z < 3; ++z) {
        EXPECT_TRUE(
            std::binary_search(set.codes.begin(), set.codes.end(), morton_encode({x, y, z})))
            << x << y << z;
      }
    }
  }
  EXPECT_EQ(set.codes.size(), 8u + 2u);
}

TEST(VoxelizerExact, TrianglesThatSpanTheGrid) {
  TriangleMesh mesh = test::triangle({0, 0, 0}, {1, 1, 0.1}, {0.2, 1, 1});
  add(mesh, {0, 1, 0}, {1, 0, 0}, {0.5, 0.5, 1});  // blocks, rows and layers all change
  expect_exactly_the_voxels(mesh, 1.0 / 53);
}

TEST(VoxelizerExact, FarFromTheOrigin) {
  for (const double distance : {1e3, 1e6, -1e6}) {
    expect_exactly_the_voxels(test::moved(random_triangles(7, 40), {distance, -distance, distance}),
                              0.13);
    expect_exactly_the_voxels(
        test::moved(test::box({0, 0, 0}, {4, 3, 2}), {distance, distance + 1, 0.1}), 0.5);
  }
}

TEST(VoxelizerExact, AGridOfOneVoxelHoldsEverything) {
  const VoxelSet set = expect_exactly_the_voxels(random_triangles(8, 5), 1000);
  EXPECT_EQ(set.codes, Codes{0});
  EXPECT_EQ(set.lattice.depth, 0);
}

TEST(VoxelizerExact, TrianglesOnThePadAreDecidedWithinIt) {
  // Just above a plane of the grid, by parts and multiples of the pad.
  for (const double pads : {0.0, 0.25, 0.5, 0.9, 0.999, 1.001, 1.5, 4.0}) {
    TriangleMesh mesh = test::triangle({0, 0, 0}, {8, 0, 0}, {0, 0, 0});
    const double z = 2 + pads * 8e-9;
    add(mesh, {1, 1, z}, {5, 1, z}, {1, 5, z});
    add(mesh, {1, z, 1}, {5, z, 1}, {1, z + 4, 5});
    expect_exactly_the_voxels(mesh, 1);
  }
}

TEST(VoxelizerExact, APowerOfTwoChangesNothingButTheScale) {
  const TriangleMesh mesh = random_triangles(9, 30);
  const VoxelSet set = voxelize(mesh, {0.11, true});
  for (int k = -35; k <= 40; k += 5) {
    TriangleMesh scaled = mesh;
    for (Vector3d& vertex : scaled.vertices) vertex *= std::ldexp(1.0, k);
    const VoxelSet other = voxelize(scaled, {std::ldexp(0.11, k), true});
    EXPECT_EQ(other.codes, set.codes) << k;
    EXPECT_EQ(other.triangles.first, set.triangles.first) << k;
    EXPECT_EQ(other.triangles.ids, set.triangles.ids) << k;
    for (std::size_t i = 0; i < set.normals.size(); ++i) {
      ASSERT_EQ(other.normals[i].word(), set.normals[i].word()) << k;
    }
  }
}

}  // namespace
}  // namespace ist
