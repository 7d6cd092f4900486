#include "verify/leaf_geometry.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

ClippedTriangle corners_in_order(std::initializer_list<Vector3d> corners) {
  ClippedTriangle result;
  for (const Vector3d& p : corners) {
    result.corners[static_cast<std::size_t>(result.count++)] = p;
  }
  return result;
}

TEST(CubeAxes, MeetUpToTheirFaces) {
  const Eigen::Matrix3d same = Eigen::Matrix3d::Identity();
  const CubeAxes axes(1, 2, same);
  EXPECT_TRUE(axes.surely_meet({0, 0, 0}));
  for (const double sign : {-1, 1}) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      EXPECT_TRUE(axes.surely_meet(sign * 1.49999 * Vector3d::Unit(i)));
      EXPECT_FALSE(axes.surely_meet(sign * 1.5 * Vector3d::Unit(i)));  // touch: not for certain
      EXPECT_FALSE(axes.surely_meet(sign * 1.6 * Vector3d::Unit(i)));
    }
  }
  EXPECT_TRUE(axes.surely_meet({1.49999, -1.49999, 1.49999}));
}

TEST(CubeAxes, MeetUpToTheirEdgesAndCorners) {
  // An edge towards a face, and an edge towards an edge.
  const double half_diagonal = std::sqrt(0.5);
  const Eigen::Matrix3d z = Eigen::AngleAxisd(M_PI / 4, Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_TRUE(CubeAxes(1, 1, z).surely_meet({0.4999 + half_diagonal, 0, 0}));
  EXPECT_FALSE(CubeAxes(1, 1, z).surely_meet({0.5001 + half_diagonal, 0, 0}));
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(M_PI / 2, Vector3d(1, 1, 0).normalized()).toRotationMatrix() * z;
  for (const double part : {0.999, 1.001}) {
    const CubeAxes axes(1, 1, turned);
    // Both have an edge across the line between their centres.
    const Vector3d direction = Vector3d(1, 1, 0).normalized();
    double reach = half_diagonal;
    for (Eigen::Index i = 0; i < 3; ++i) reach += 0.5 * std::abs(turned.col(i).dot(direction));
    EXPECT_EQ(axes.surely_meet(part * reach * direction), part < 1) << reach;
  }
  // So little turned that edges are nearly parallel.
  for (const double angle : {1e-3, 1e-6, 1e-8, 1e-12, 1e-16}) {
    const CubeAxes axes(
        1, 1, Eigen::AngleAxisd(angle, Vector3d(1, 2, 3).normalized()).toRotationMatrix());
    EXPECT_TRUE(axes.surely_meet({0.99, 0.99, 0.99})) << angle;
    EXPECT_FALSE(axes.surely_meet({0, 0, 1.01})) << angle;
  }
}

TEST(SurelyCross, ThroughTouchingAndApart) {
  const ClippedTriangle face = corners_in_order({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  const auto cross = [&face](std::initializer_list<Vector3d> corners) {
    const bool one = surely_cross(face, corners_in_order(corners), 1e-12);
    EXPECT_EQ(surely_cross(corners_in_order(corners), face, 1e-12), one);
    return one;
  };
  EXPECT_TRUE(cross({{1, 2, -1}, {1, 2, 1}, {2, 3, 1}}));
  EXPECT_TRUE(cross({{-1, 1, -1}, {5, 1, -1}, {2, 1, 1}}));  // all its edges pass outside
  EXPECT_TRUE(cross({{1, 2, -1e-9}, {1, 2, 1}, {2, 3, 1}}));
  EXPECT_FALSE(cross({{1, 2, 0}, {1, 2, 1}, {2, 3, 1}}));              // touches with a corner
  EXPECT_FALSE(cross({{1, 2, 1e-9}, {1, 2, 1}, {2, 3, 1}}));           // just apart
  EXPECT_FALSE(cross({{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}));              // in one plane
  EXPECT_FALSE(cross({{5, 2, -1}, {5, 2, 1}, {6, 3, 1}}));             // beside it
  EXPECT_FALSE(cross({{4, 2, -1}, {4, 2, 1}, {6, 3, 1}}));             // along its edge
  EXPECT_FALSE(cross({{1, 2, 1}, {1, 2, 1}, {1, 2, 1}}));              // a point
  EXPECT_TRUE(cross({{1, 2, -1}, {1, 2, 1}, {1, 2 + 1e-7, 1}}));       // a sliver
  EXPECT_TRUE(cross({{0, 1, -1}, {0, 1, 1}, {4, 1, 1}, {4, 1, -1}}));  // from edge to edge
  EXPECT_FALSE(surely_cross(face, ClippedTriangle{}, 1e-12));
  // What would be apart, had each corner moved by as much as is doubted.
  EXPECT_FALSE(surely_cross(face, corners_in_order({{1, 2, -1e-4}, {1, 2, 1}, {2, 3, 1}}), 1e-3));
}

TEST(LeafPolygons, LieInTheirCubesAndCoverTheMesh) {
  const TriangleMesh mesh = icosphere(1, 2);
  BuildOptions options;
  options.voxel_size = 0.37;
  options.keep_triangles = true;
  const SphereTree tree = build_tree(mesh, options);
  const std::vector<std::uint64_t> codes = voxels_of(tree).octree.codes(0);
  double area = 0, whole = 0;
  const auto twice = [](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    return (b - a).cross(c - a).norm();
  };
  for (std::uint32_t leaf = 0; leaf < codes.size(); ++leaf) {
    const Vector3d centre =
        options.voxel_size * cube_centre(voxels_of(tree).lattice, 0, codes[leaf]);
    for (const ClippedTriangle& piece : leaf_polygons(tree, leaf, codes[leaf])) {
      for (int i = 0; i < piece.count; ++i) {
        const Vector3d& p = piece.corners[static_cast<std::size_t>(i)];
        EXPECT_LE((p - centre).cwiseAbs().maxCoeff(), 0.5 * options.voxel_size + 1e-12);
        if (i > 1)
          area += twice(piece.corners[0], piece.corners[static_cast<std::size_t>(i - 1)], p);
      }
    }
  }
  for (const Triangle& t : mesh.triangles) {
    whole += twice(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  }
  EXPECT_NEAR(area, whole, 1e-9);
}

TEST(LeafGrid, FindsAllThatAreNear) {
  Random random(3);
  const SphereTree tree = tree_of(icosphere(2, 1), 13);
  const std::vector<std::uint64_t> codes = voxels_of(tree).octree.codes(0);
  const double edge = tree.voxel_size();
  for (const double radius : {0.1 * edge, 0.9 * edge, 7 * edge, 100 * edge}) {
    const LeafGrid grid(tree, radius);
    for (int i = 0; i < samples(50); ++i) {
      const Vector3d centre = random.point(-1.5, 1.5);
      std::multiset<std::uint32_t> found;
      grid.near(centre, radius, [&](std::uint32_t leaf) { found.insert(leaf); });
      for (std::uint32_t leaf = 0; leaf < codes.size(); ++leaf) {
        const double apart = (edge * cube_centre(voxels_of(tree).lattice, 0, codes[leaf]) - centre)
                                 .cwiseAbs()
                                 .maxCoeff();
        EXPECT_LE(found.count(leaf), 1u);
        if (apart <= radius + 0.5 * edge) {
          EXPECT_EQ(found.count(leaf), 1u);
        } else if (apart > radius + 2.5 * edge) {
          EXPECT_EQ(found.count(leaf), 0u);
        }
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
