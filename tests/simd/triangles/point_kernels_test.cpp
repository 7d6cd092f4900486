#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "ist/base/ordered_vector.h"
#include "ist/mesh/nearest_point.h"
#include "query/query_cases.h"
#include "simd/targets.h"
#include "simd/triangles/cluster_cases.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;

double distance_to(const TriangleMesh& mesh, std::uint32_t triangle, const Vector& p) {
  const Triangle& t = mesh.triangles[triangle];
  const auto& v = mesh.vertices;
  return (p - nearest_on_triangle({v[t[0]], v[t[1]], v[t[2]]}, p).point).norm();
}

Vector in_tree(const TriangleClusters& clusters, const Vector& p) {
  return clusters.axes().transpose() * p;
}

TreePoint tree_point(const Vector& at, double error) {
  TreePoint point{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = at[static_cast<Eigen::Index>(i)];
    point.at[i] = static_cast<float>(x);
    point.rest[i] = static_cast<float>(x - double{point.at[i]});
  }
  point.error = static_cast<float>(error);
  return point;
}

ClusterPoint cluster_point(const TriangleClusters& clusters, std::uint32_t index, const Vector& at,
                           double error) {
  const TriangleCluster& cluster = clusters.clusters()[index];
  const NodeBlock& block = clusters.bounds(0)[index / kClusterWidth];
  ClusterPoint point{};
  double size = block.radius[index % kClusterWidth];
  for (std::size_t i = 0; i < 3; ++i) {
    double along = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      along += double{cluster.axis[k][i]} *
               (at[static_cast<Eigen::Index>(k)] - double{block.centre[k][index % kClusterWidth]});
    }
    point.at[i] = static_cast<float>(along);
    size += std::abs(along);
  }
  point.error = static_cast<float>(error + kPointRounding * size);
  return point;
}

class PointKernels : public ::testing::TestWithParam<std::string> {
 protected:
  const ClusterKernels& kernels_ = select_kernels(GetParam()).clusters;
};

// Points near and far, on the surface and in a corner.
std::vector<Vector> points_of(const TriangleMesh& mesh, Random& random) {
  std::vector<Vector> points;
  for (int i = 0; i < samples(40); ++i) {
    const Vector& at = mesh.vertices[random.below(mesh.vertices.size())];
    points.push_back(at +
                     std::ldexp(1.0, -static_cast<int>(random.below(40))) * random.direction());
    points.push_back(at + random.uniform(0, 100) * random.direction());
  }
  points.push_back(mesh.vertices[0]);
  return points;
}

TEST_P(PointKernels, BoundNodesFromBelowAndWithTheBitsOfTheScalarForm) {
  Random random(23);
  for (const ClusterCase& one : cluster_cases()) {
    const TriangleClusters& clusters = one.fixed_clusters;
    for (const Vector& p : points_of(one.fixed, random)) {
      const TreePoint point = tree_point(in_tree(clusters, p), 1e-13 * (1 + p.norm()));
      for (std::uint32_t block = 0; block < clusters.bounds(0).size(); ++block) {
        alignas(64) float squares[kClusterWidth], scalar[kClusterWidth];
        const float far = static_cast<float>(random.uniform(0, 100));
        const NodeBlock& nodes = clusters.bounds(0)[block];
        const std::uint32_t near = kernels_.near_nodes(nodes, point, far, squares);
        EXPECT_EQ(near, kScalarClusterKernels.near_nodes(nodes, point, far, scalar));
        for (std::uint32_t lane = 0; lane < clusters.child_count(0, block); ++lane) {
          const std::uint32_t index = kClusterWidth * block + lane;
          ASSERT_EQ(squares[lane], scalar[lane]) << one.name;
          ASSERT_EQ(near >> lane & 1, squares[lane] > far ? 0U : 1U);
          double least = HUGE_VAL;
          for (std::uint32_t k = 0; k < clusters.child_count(-1, index); ++k) {
            least = std::min(least, distance_to(one.fixed, clusters.clusters()[index].id[k], p));
          }
          ASSERT_LE(squares[lane], least * least) << one.name << ' ' << p.transpose();
        }
      }
    }
  }
}

TEST_P(PointKernels, KeepTheNearestTriangleAndAllThatAreAsNear) {
  Random random(29);
  for (const ClusterCase& one : cluster_cases()) {
    const TriangleClusters& clusters = one.fixed_clusters;
    for (const Vector& p : points_of(one.fixed, random)) {
      for (std::uint32_t index = 0; index < clusters.node_count(0); ++index) {
        const ClusterPoint point =
            cluster_point(clusters, index, in_tree(clusters, p), 1e-13 * (1 + p.norm()));
        const TriangleCluster& cluster = clusters.clusters()[index];
        alignas(64) float squares[kClusterWidth];
        float far = std::numeric_limits<float>::infinity();
        const std::uint32_t near = kernels_.near_triangles(cluster, point, far, squares);
        double least = HUGE_VAL;
        for (std::uint32_t k = 0; k < clusters.child_count(-1, index); ++k) {
          const double truth = distance_to(one.fixed, cluster.id[k], p);
          ASSERT_LE(squares[k], truth * truth) << one.name << ' ' << p.transpose();
          ASSERT_EQ(near >> k & 1, squares[k] > far ? 0U : 1U);
          least = std::min(least, truth);
        }
        ASSERT_GE(far, least * least) << one.name << ' ' << p.transpose();
        // A limit that is given is only lowered.
        float limit = far * 0.5F;
        static_cast<void>(kernels_.near_triangles(cluster, point, limit, squares));
        ASSERT_LE(limit, far * 0.5F);
      }
    }
  }
}

TEST_P(PointKernels, BoundAFaceAnEdgeAndACornerToWithinAFewRoundings) {
  const TriangleMesh mesh = triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  const TriangleClusters clusters(mesh, Vector::Zero());
  for (const Vector& p : {Vector(1, 1, 0.5), Vector(2, -1, 0.25), Vector(5, -1, 1), Vector(3, 3, 0),
                          Vector(-1, -1, -1), Vector(1, 1, 1e-3)}) {
    const ClusterPoint point = cluster_point(clusters, 0, in_tree(clusters, p), 0);
    alignas(64) float squares[kClusterWidth];
    float far = std::numeric_limits<float>::infinity();
    EXPECT_EQ(kernels_.near_triangles(clusters.clusters()[0], point, far, squares) & 1, 1U);
    const double truth = distance_to(mesh, 0, p);
    EXPECT_GE(std::sqrt(squares[0]), truth - 4 * double{point.error}) << p.transpose();
    EXPECT_LE(std::sqrt(far), truth + 2 * kPlaneError * double{point.error}) << p.transpose();
  }
}

TEST_P(PointKernels, LeaveNothingOutWhereFloatsOverflow) {
  const TriangleMesh mesh = triangle({0, 0, 0}, {1e15, 0, 0}, {0, 1e15, 0});
  const TriangleClusters clusters(mesh, Vector::Zero());
  const Vector p(2e14, 2e14, 1e14);
  alignas(64) float squares[kClusterWidth];
  float far = 1.0001e28F;
  EXPECT_EQ(
      kernels_.near_triangles(clusters.clusters()[0],
                              cluster_point(clusters, 0, in_tree(clusters, p), 1), far, squares) &
          1,
      1U);
  EXPECT_GE(far, 1e28F);
}

INSTANTIATE_TEST_SUITE_P(Targets, PointKernels, ::testing::ValuesIn(all_targets()), name_of);

}  // namespace
}  // namespace ist::test
