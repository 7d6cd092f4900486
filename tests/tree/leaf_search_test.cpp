#include "ist/tree/leaf_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ist/tree/bound_builder.h"
#include "ist/tree/nested_bounds.h"
#include "ist/voxel/voxelizer.h"
#include "support/effort.h"
#include "support/exact_nesting.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist {
namespace {

using Eigen::Vector3d;

// A normal as blocks hold it, of length 0.98 to 1.
Vector3d packed_normal(test::Random& random) {
  Vector3d normal = random.uniform(126.5, 127) * random.direction();
  for (double& x : normal) x = std::floor(x + 0.5) / 128;
  return normal;
}

// The value to a few roundings, against a decision in rational numbers on both sides of it.
void expect_support(const Ball& ball, const Slab& slab, double partner_radius,
                    const Vector3d& normal, const Vector3d& from) {
  const InflatedBound bound(ball, slab, partner_radius);
  const double length = normal.norm();
  const double value = bound.support(normal, length, from);
  const double error = 0x1p-49 * (ball.radius + partner_radius + (ball.centre - from).norm());
  const test::ExactBound exact{test::exact(ball.centre), ball.radius, test::exact(slab.normal),
                               slab.offset, slab.half};
  const auto below = [&](double limit) {
    return test::stays_below(exact, partner_radius, test::exact(normal), test::exact(from), limit);
  };
  ASSERT_TRUE(below(value + error)) << value;
  ASSERT_FALSE(below(value - error)) << value;
  const Vector3d point = bound.support_point(normal, length);
  ASSERT_NEAR(normal.dot(point - from), value, 1e-9 * (1 + std::abs(value)));
  ASSERT_LE((point - ball.centre).norm(), (ball.radius + partner_radius) * (1 + 1e-9));
}

TEST(InflatedBound, SupportsAreExactToAFewRoundings) {
  test::Random random(1);
  for (int i = 0; i < test::samples(20'000); ++i) {
    const Ball ball{random.point(-5, 5), random.uniform(0.01, 0.87)};
    Slab slab{packed_normal(random), ball.radius * random.uniform(-0.6, 0.6),
              random.uniform(0, 0.4)};
    Vector3d normal = packed_normal(random);
    // Every other normal is close to the slab's, to its opposite, or the same.
    if (i % 2 == 0) {
      normal = (i % 4 == 0 ? 1 : -1) * slab.normal;
      if (i % 8 < 4) normal[i % 3] += (std::abs(normal[i % 3]) < 0.9 ? 1.0 : -1.0) / 128;
      if (normal.norm() > 1) continue;
    }
    if (i % 100 == 99) slab = {Vector3d::Zero(), 0, 1};  // holds everything
    ASSERT_NO_FATAL_FAILURE(
        expect_support(ball, slab, i % 3 == 0 ? 0 : kPartnerRadius, normal, random.point(-5, 5)));
  }
}

struct BuiltTree {
  explicit BuiltTree(const TriangleMesh& mesh, double voxel_size)
      : voxels(voxelize(mesh, {voxel_size, true})),
        octree(voxels.codes, voxels.lattice.depth),
        bounds(build_bounds(SpherePolicy::kSlab, mesh, voxels, octree)) {}

  VoxelSet voxels;
  LinearOctree octree;
  BoundBlocks bounds;
};

// Each child below is a node at level 1, so that it gives the leaves one by one.
void append_leaves(const BuiltTree& tree, int level, std::uint32_t node, std::vector<Ball>& balls,
                   std::vector<Slab>& slabs) {
  if (level == 1) {
    LeafSearch search(tree.octree, tree.bounds, 1);
    search.set_node(node);
    for (int slot = 0; slot < tree.octree.child_count(1, node); ++slot) {
      balls.push_back(search.child_ball(slot));
      slabs.push_back(search.child_slab(slot));
    }
    return;
  }
  const std::uint32_t first = tree.octree.first_child(level, node);
  for (int slot = 0; slot < tree.octree.child_count(level, node); ++slot) {
    append_leaves(tree, level - 1, first + static_cast<std::uint32_t>(slot), balls, slabs);
  }
}

// The greatest of all leaves, to the last bit: nothing that counts is passed over.
TEST(LeafSearch, FindsTheGreatestOfAllLeaves) {
  const BuiltTree tree(test::icosphere(3, 1), 0.08);
  test::Random random(2);
  for (int level = 1; level <= tree.octree.depth(); ++level) {
    LeafSearch search(tree.octree, tree.bounds, level);
    for (std::uint32_t node = 0; node < tree.octree.node_count(level); node += 5) {
      std::vector<Ball> balls;
      std::vector<Slab> slabs;
      append_leaves(tree, level, node, balls, slabs);
      search.set_node(node);
      const Vector3d from = balls[random.below(static_cast<std::uint32_t>(balls.size()))].centre +
                            random.uniform(0, 3) * random.direction();
      const Vector3d normal = packed_normal(random);
      const double length =
          std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
      double farthest = 0, highest = -HUGE_VAL;
      for (std::size_t i = 0; i < balls.size(); ++i) {
        farthest = std::max(farthest, (balls[i].centre - from).norm() + balls[i].radius);
        highest = std::max(highest, height_of(InflatedBound(balls[i], slabs[i], kPartnerRadius),
                                              normal, length, from));
      }
      ASSERT_NEAR(search.farthest(from).value, farthest, 1e-14 * farthest);
      Greatest<InflatedBound> greatest;
      search.raise_support(normal, from, greatest);
      ASSERT_EQ(greatest.value, highest);
      ASSERT_EQ(height_of(greatest.bound, normal, length, from), highest);
      greatest.value = highest + 1;  // what is greater already is left
      search.raise_support(normal, from, greatest);
      ASSERT_EQ(greatest.value, highest + 1);
    }
  }
}

}  // namespace
}  // namespace ist
