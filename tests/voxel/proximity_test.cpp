// Proximity voxels against brute force: distances exact, inside by the solid angle of the surface.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ist/base/parallel.h"
#include "ist/voxel/classify.h"
#include "ist/voxel/voxelizer.h"
#include "support/errors.h"
#include "support/exact.h"
#include "support/shapes.h"

namespace ist {
namespace {

using Eigen::Vector3d;
using Codes = std::vector<std::uint64_t>;

// How often the surface winds round a point that does not lie on it. Source: A. van Oosterom, J.
// Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30(2), 1983.
double winding(const TriangleMesh& mesh, const Vector3d& point) {
  double angle = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector3d a = mesh.vertices[i] - point, b = mesh.vertices[j] - point,
                   c = mesh.vertices[k] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * 3.141592653589793);
}

// Whether a triangle is at most `range` from the point; its bounding box first, for it is cheap.
bool is_near(const test::ExactPolygon& triangle, const test::ExactPoint& point,
             const mpq_class& range) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
    if (point[axis] < low - range || point[axis] > high + range) return false;
  }
  return test::distance_squared(point, triangle) <= range * range;
}

Codes expected_proximity(const TriangleMesh& mesh, const VoxelSet& surface) {
  std::vector<test::ExactPolygon> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    triangles.push_back(test::exact_triangle(mesh, t));
  }
  const mpq_class size(surface.lattice.voxel_size), range = 2 * size;
  const auto cells = static_cast<int>(surface.lattice.cells);
  constexpr int kMargin = 5;  // wider than the library's: nothing may lie beyond that
  Codes codes;
  for (int z = -kMargin; z < cells + kMargin; ++z) {
    for (int y = -kMargin; y < cells + kMargin; ++y) {
      for (int x = -kMargin; x < cells + kMargin; ++x) {
        const int cell[3] = {x, y, z};
        test::ExactPoint centre;
        Vector3d rounded;
        for (std::size_t i = 0; i < 3; ++i) {
          centre[i] = mpq_class(surface.lattice.corner[i]) + mpq_class(2 * cell[i] + 1, 2) * size;
          rounded[static_cast<Eigen::Index>(i)] = centre[i].get_d();
        }
        if (std::none_of(triangles.begin(), triangles.end(),
                         [&](const auto& t) { return is_near(t, centre, range); })) {
          continue;
        }
        const bool in_grid =
            std::all_of(cell, cell + 3, [&](int i) { return i >= 0 && i < cells; });
        const auto index = [](int i) { return static_cast<std::uint32_t>(i); };
        if (in_grid && std::binary_search(surface.codes.begin(), surface.codes.end(),
                                          morton_encode({index(x), index(y), index(z)}))) {
          continue;
        }
        const double wound = winding(mesh, rounded);
        EXPECT_NEAR(wound, std::round(wound), 1e-6);
        if (std::round(wound) != 0) continue;
        EXPECT_TRUE(std::all_of(cell, cell + 3, [&](int i) { return i >= -2 && i < cells + 2; }));
        codes.push_back(morton_encode({index(x + 2), index(y + 2), index(z + 2)}));
      }
    }
  }
  std::sort(codes.begin(), codes.end());
  return codes;
}

void expect_exactly_the_proximity_voxels(const TriangleMesh& mesh, double voxel_size) {
  const VoxelSet surface = voxelize(mesh, {voxel_size, false});
  const Codes before = surface.codes;
  const Codes found = proximity_voxels(mesh, surface);
  EXPECT_FALSE(found.empty());
  EXPECT_EQ(found, expected_proximity(mesh, surface));
  EXPECT_EQ(surface.codes, before);
}

TriangleMesh l_shape() {
  // The outline turns counter clockwise seen from +z; two quadrilaterals make its area.
  constexpr double kOutline[6][2] = {{0, 0}, {4, 0}, {4, 1.5}, {1.5, 1.5}, {1.5, 4}, {0, 4}};
  TriangleMesh mesh;
  for (const double z : {0.0, 1.7}) {
    for (const auto& [x, y] : kOutline) mesh.vertices.emplace_back(x, y, z);
  }
  for (const auto& [a, b, c] :
       {Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}, Triangle{0, 4, 5}}) {
    mesh.triangles.push_back({a + 6, b + 6, c + 6});
    mesh.triangles.push_back({a, c, b});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t next = (i + 1) % 6;
    mesh.triangles.push_back({i, next, next + 6});
    mesh.triangles.push_back({i, next + 6, i + 6});
  }
  return mesh;
}

TEST(Proximity, OfBoxesOnTheGridAndOffIt) {
  expect_exactly_the_proximity_voxels(test::box({0, 0, 0}, {4, 4, 4}), 1);
  expect_exactly_the_proximity_voxels(test::box({0, 0, 0}, {4.5, 3.5, 2}), 1);
  expect_exactly_the_proximity_voxels(test::box({-1, 2, 0.3}, {1.1, 3, 2}), 0.43);
}

TEST(Proximity, ACentreExactlyTwoEdgesAwayIsInRange) {
  const TriangleMesh mesh = test::box({0, 0, 0}, {3.5, 3.5, 3.5});
  const VoxelSet surface = voxelize(mesh, {1, false});
  const Codes codes = proximity_voxels(mesh, surface);
  const auto has = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return std::binary_search(codes.begin(), codes.end(), morton_encode({x + 2, y + 2, z + 2}));
  };
  EXPECT_TRUE(has(5, 1, 1)) << "its centre, 5.5, is two edges from the face at 3.5";
  EXPECT_TRUE(has(4, 1, 1));
  EXPECT_FALSE(has(5, 5, 1));
}

TEST(Proximity, OfAnIcosphere) { expect_exactly_the_proximity_voxels(test::icosphere(1, 1), 0.24); }

TEST(Proximity, OfAnLShapeWithANotch) {
  expect_exactly_the_proximity_voxels(l_shape(), 0.5);
  expect_exactly_the_proximity_voxels(l_shape(), 0.37);
}

// Beyond a sharp corner or edge, some of the faces that meet there turn their backs to a point
// outside.
TEST(Proximity, RoundSharpCornersAndEdges) {
  TriangleMesh spike;
  spike.vertices = {{0, 0, 0}, {0.9, 0.1, 0.2}, {0.2, 0.8, -0.1}, {2.9, 3.1, 4}};
  spike.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  TriangleMesh wedge;
  wedge.vertices = {{0, 0, 0}, {3, 0.4, 0.1}, {0.2, 3, 3}, {3.1, 3.2, 2.9}, {0.5, -0.6, 0.8}};
  wedge.triangles = {{0, 1, 4}, {1, 3, 4}, {3, 2, 4}, {2, 0, 4}, {0, 2, 1}, {1, 2, 3}};
  for (TriangleMesh mesh : {spike, wedge}) {
    for (int turn = 0; turn < 3; ++turn) {  // another triangle comes first
      expect_exactly_the_proximity_voxels(mesh, 0.47);
      std::rotate(mesh.triangles.begin(), mesh.triangles.begin() + 1, mesh.triangles.end());
    }
  }
}

TEST(Proximity, OfAShellWithACavityLooksIntoTheCavity) {
  const TriangleMesh shell = test::joined(test::box({0, 0, 0}, {9, 9, 9}),
                                          test::inside_out(test::box({2, 2, 2}, {7, 7, 7})));
  expect_exactly_the_proximity_voxels(shell, 1);
}

TEST(Proximity, OfPartsThatOverlapLiesOutsideBoth) {
  const TriangleMesh cube = test::box({0, 0, 0}, {2, 2, 2});
  expect_exactly_the_proximity_voxels(test::joined(cube, test::moved(cube, {0.9, 0.7, 0.8})), 0.21);
}

TEST(Proximity, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = test::icosphere(3, 1);
  const VoxelSet surface = voxelize(mesh, {0.03, false});
  const Codes all = proximity_voxels(mesh, surface);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  for (const std::size_t threads : {1u, 2u, 7u}) {
    const ScopedThreadLimit limit(threads);
    EXPECT_EQ(proximity_voxels(mesh, surface), all);
  }
}

TEST(Proximity, AGridWithoutRoomForTheMarginIsRefused) {
  const TriangleMesh needle = test::triangle({0, 0, 0}, {65533, 0, 0}, {65533, 0.5, 0});
  const VoxelSet surface = voxelize(needle, {1, false});
  EXPECT_EQ(test::error_name([&] { (void)proximity_voxels(needle, surface); }),
            "voxel-size-too-small");
}

}  // namespace
}  // namespace ist
