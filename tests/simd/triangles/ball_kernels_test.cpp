#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "query/query_cases.h"
#include "simd/targets.h"
#include "simd/triangles/cluster_cases.h"
#include "support/effort.h"

// Kernels that bound depths by outer balls, against their scalar forms and against points in
// double.
namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;

// A field of any balls: what the kernels compute does not depend on the surface.
OuterBalls random_field(Random& random) {
  OuterBalls field;
  field.unit = 0x1p-8;
  field.middle = {0.25, -0.5, 1};
  field.cell = 200;
  field.half = {1500, 900, 1200};
  field.groups = {4, 3, 5};
  std::uint32_t count = 0;
  for (std::uint32_t group = 0; group < 4 * 3 * 5; ++group) {
    const bool is_split = random.below(2) != 0;
    field.first.push_back(static_cast<std::int32_t>(2 * count + (is_split ? 1 : 0)));
    count += is_split ? OuterBalls::kGroupCells : 1;
  }
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto coordinate = [&] { return static_cast<std::int32_t>(random.below(65535)) - 32767; };
    field.balls.emplace_back(std::array{coordinate(), coordinate(), coordinate()},
                             static_cast<std::uint32_t>(random.below(65536)));
  }
  return field;
}

// The pose of a cluster frame in a field.
struct Placed {
  Eigen::Matrix3d rotation;
  Vector translation;  // units
  BallPose pose{};

  Placed(const TriangleClusters& clusters, const OuterBalls& field, Random& random)
      : rotation(random.rotation()), translation(1000 * random.direction()) {
    double size = std::sqrt(3.0) * clusters.extent() / field.unit;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      for (std::size_t k = 0; k < 3; ++k) {
        pose.rotation[i][k] = static_cast<float>(rotation(row, static_cast<Eigen::Index>(k)));
      }
      pose.translation[i] = static_cast<float>(translation[row]);
      size += std::abs(translation[row]);
    }
    pose.scale = static_cast<float>(1 / field.unit);
    pose.pad = static_cast<float>(0x1p-18 * size);
  }
  // Cluster frame, mesh units, to the field's units.
  [[nodiscard]] Vector operator()(const Vector& p, const OuterBalls& field) const {
    return rotation * (p / field.unit) + translation;
  }
};

bool same_bits(const float* a, const float* b) {
  return std::memcmp(a, b, kClusterWidth * sizeof(float)) == 0;
}

bool same(const BallLanes& a, const BallLanes& b) { return a.over == b.over && a.most == b.most; }

// The bound of a point by the ball of the cell that holds another one, in double; or by the box.
double bound_of(const OuterBalls& field, const Vector& p, const Vector& in_cell) {
  std::uint32_t cell[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const double at =
        (in_cell[static_cast<Eigen::Index>(i)] - double{field.low(i)}) / double{field.cell};
    cell[i] = static_cast<std::uint32_t>(std::clamp(at, 0.0, 4.0 * field.groups[i] - 1));
  }
  const OuterBall& ball = field.balls[field.ball_at(cell[0], cell[1], cell[2])];
  return (p - Vector(ball.x(), ball.y(), ball.z())).norm() - ball.radius();
}

double depth_in_box(const OuterBalls& field, const Vector& p) {
  double depth = HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    depth = std::min(depth, double{field.half[i]} - std::abs(p[static_cast<Eigen::Index>(i)]));
  }
  return depth;
}

class BallKernels : public ::testing::TestWithParam<std::string> {
 protected:
  const ClusterKernels& kernels_ = select_kernels(GetParam()).clusters;
};

TEST_P(BallKernels, BoundNodesWithTheBitsOfTheScalarForm) {
  Random random(31);
  for (const ClusterCase& one : cluster_cases()) {
    const OuterBalls field = random_field(random);
    const BallGrid grid = grid_of(field);
    const TriangleClusters& clusters = one.moving_clusters;
    for (int i = 0; i < samples(10); ++i) {
      const Placed placed(clusters, field, random);
      const auto block = static_cast<std::uint32_t>(random.below(clusters.bounds(0).size()));
      const NodeBlock& nodes = clusters.bounds(0)[block];
      const std::uint32_t lanes = (1U << clusters.child_count(0, block)) - 1;
      alignas(64) float found[kClusterWidth], scalar[kClusterWidth];
      const auto limit = static_cast<float>(random.uniform(-40'000, 40'000));
      const BallLanes got = kernels_.bound_nodes(nodes, grid, placed.pose, limit, lanes, found);
      ASSERT_TRUE(same(got, bound_nodes_scalar(nodes, grid, placed.pose, limit, lanes, scalar)))
          << one.name;
      ASSERT_TRUE(same_bits(found, scalar)) << one.name;
      for (std::uint32_t lane = 0; lane < clusters.child_count(0, block); ++lane) {
        ASSERT_EQ(got.over >> lane & 1U, found[lane] <= limit ? 0U : 1U);
        if (found[lane] <= limit) {
          ASSERT_LE(found[lane], got.most);
        }
      }
      ASSERT_EQ(got.over & ~lanes, 0U);
    }
  }
}

// Corners of the triangles in a node, in the cluster frame.
template <class Body>
void for_each_triangle(const TriangleClusters& clusters, std::uint32_t cluster, const Body& body) {
  const TriangleCluster& one = clusters.clusters()[cluster];
  const NodeBlock& nodes = clusters.bounds(0)[cluster / kClusterWidth];
  const std::size_t lane = cluster % kClusterWidth;
  for (std::uint32_t k = 0; k < clusters.child_count(-1, cluster); ++k) {
    std::array<Vector, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        double at = nodes.centre[axis][lane];
        for (std::size_t along = 0; along < 3; ++along) {
          at += double{one.axis[axis][along]} * double{one.corner[i][along][k]};
        }
        corners[i][static_cast<Eigen::Index>(axis)] = at;
      }
    }
    body(k, corners);
  }
}

TEST_P(BallKernels, BoundAllPointsOfANode) {
  Random random(37);
  for (const ClusterCase& one : cluster_cases()) {
    const OuterBalls field = random_field(random);
    const BallGrid grid = grid_of(field);
    const TriangleClusters& clusters = one.moving_clusters;
    const Placed placed(clusters, field, random);
    for (int i = 0; i < samples(10); ++i) {
      const auto cluster = static_cast<std::uint32_t>(random.below(clusters.node_count(0)));
      const NodeBlock& nodes = clusters.bounds(0)[cluster / kClusterWidth];
      const std::size_t lane = cluster % kClusterWidth;
      alignas(64) float bounds[kClusterWidth];
      static_cast<void>(kernels_.bound_nodes(nodes, grid, placed.pose, 0, 0xFFFF, bounds));
      // The middle may lie in either of two cells.
      const Vector middle =
          placed({nodes.centre[0][lane], nodes.centre[1][lane], nodes.centre[2][lane]}, field);
      for_each_triangle(clusters, cluster, [&](std::uint32_t, const auto& corners) {
        for (const Vector& corner : corners) {
          const Vector p = placed(corner, field);
          double least = depth_in_box(field, p);
          for (const double off : {-0.01, 0.01}) {
            least = std::min(least, bound_of(field, p, middle + Vector::Constant(off)));
          }
          ASSERT_GE(double{bounds[lane]}, least) << one.name;
        }
      });
    }
  }
}

TEST_P(BallKernels, BoundTrianglesByTheirCorners) {
  Random random(41);
  for (const ClusterCase& one : cluster_cases()) {
    const OuterBalls field = random_field(random);
    const BallGrid grid = grid_of(field);
    const TriangleClusters& clusters = one.moving_clusters;
    const Placed placed(clusters, field, random);
    for (int i = 0; i < samples(10); ++i) {
      const auto cluster = static_cast<std::uint32_t>(random.below(clusters.node_count(0)));
      const NodeBlock& nodes = clusters.bounds(0)[cluster / kClusterWidth];
      const std::uint32_t lanes = (1U << clusters.child_count(-1, cluster)) - 1;
      const auto limit = static_cast<float>(random.uniform(-40'000, 40'000));
      alignas(64) float bounds[kClusterWidth], scalar[kClusterWidth];
      const TriangleCluster& triangles = clusters.clusters()[cluster];
      const BallLanes got = kernels_.bound_corners(triangles, nodes, cluster % kClusterWidth, grid,
                                                   placed.pose, limit, lanes, bounds);
      ASSERT_TRUE(same(got, bound_corners_scalar(triangles, nodes, cluster % kClusterWidth, grid,
                                                 placed.pose, limit, lanes, scalar)));
      ASSERT_TRUE(same_bits(bounds, scalar)) << one.name;
      for_each_triangle(clusters, cluster, [&](std::uint32_t k, const auto& corners) {
        std::array<Vector, 3> t;
        BallTriangle floats;
        for (std::size_t c = 0; c < 3; ++c) {
          t[c] = placed(corners[c], field);
          for (std::size_t axis = 0; axis < 3; ++axis) {
            floats[c][axis] = static_cast<float>(t[c][static_cast<Eigen::Index>(axis)]);
          }
        }
        const Vector middle = (t[0] + t[1] + t[2]) / 3;
        // The least of all balls near the middle bounds each bound from below.
        double least = HUGE_VAL;
        for (const double off : {-0.01, 0.01}) {
          double most = -HUGE_VAL;
          for (const Vector& p : t) {
            most = std::max(most, bound_of(field, p, middle + Vector::Constant(off)));
          }
          least = std::min(least, most);
        }
        ASSERT_GE(double{bounds[k]}, least) << one.name;
        const float around = kernels_.bound_around(floats, grid, placed.pose.pad);
        ASSERT_EQ(around, bound_around_scalar(floats, grid, placed.pose.pad));
        // Its own pads and those of the other kernel: of places, and of distances up to 2^17.
        ASSERT_LE(double{around}, least + 2 * double{placed.pose.pad} + 2);
      });
    }
  }
}

TEST_P(BallKernels, LeaveOpenWhatFloatsDoNotHold) {
  Random random(43);
  const OuterBalls field = random_field(random);
  const BallGrid grid = grid_of(field);
  const ClusterCase one = cluster_cases()[0];
  Placed placed(one.moving_clusters, field, random);
  placed.pose.pad = HUGE_VALF;
  alignas(64) float bounds[kClusterWidth];
  const NodeBlock& nodes = one.moving_clusters.bounds(0)[0];
  EXPECT_EQ(kernels_.bound_nodes(nodes, grid, placed.pose, 1e30F, 0xFFFF, bounds).over, 0xFFFFU);
  placed.pose.pad = std::nanf("");
  EXPECT_EQ(kernels_.bound_nodes(nodes, grid, placed.pose, 1e30F, 0xFF, bounds).over, 0xFFU);
}

INSTANTIATE_TEST_SUITE_P(Targets, BallKernels, ::testing::ValuesIn(all_targets()), name_of);

}  // namespace
}  // namespace ist::test
