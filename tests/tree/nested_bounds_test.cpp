// Bounds of inner nodes against those of their leaves, in rational numbers.

#include "ist/tree/nested_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ist/models/models.h"
#include "ist/tree/bound_builder.h"
#include "ist/voxel/voxelizer.h"
#include "support/effort.h"
#include "support/exact_nesting.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist {
namespace {

using Eigen::Vector3d;
using test::ExactBound;
using test::ExactPoint;

class Nested {
 public:
  Nested(const TriangleMesh& mesh, double voxel_size, SpherePolicy policy = SpherePolicy::kSlab)
      : voxels_(voxelize(mesh, {voxel_size, true})),
        octree_(voxels_.codes, voxels_.lattice.depth),
        bounds_(build_bounds(policy, mesh, voxels_, octree_)) {
    for (std::uint32_t node = 0; node < octree_.leaf_count(); ++node) {
      leaves_.push_back(bound(0, node));
    }
  }

  [[nodiscard]] const LinearOctree& octree() const { return octree_; }
  [[nodiscard]] const BoundBlocks& bounds() const { return bounds_; }
  [[nodiscard]] const std::vector<ExactBound>& leaves() const { return leaves_; }
  [[nodiscard]] ExactBound bound(int level, std::uint32_t node) const {
    const auto parents = octree_.nodes(level + 1);
    const auto after =
        std::upper_bound(parents.begin(), parents.end(), node,
                         [](std::uint32_t n, const OctreeNode& p) { return n < p.first_child; });
    const auto parent = static_cast<std::uint32_t>(after - parents.begin() - 1);
    return test::exact_bound(bounds_, octree_, level, parent,
                             static_cast<int>(node - parents[parent].first_child));
  }
  // Calls `check` with each inner node, or every `step`-th, and the range of its leaves.
  template <class Check>
  void each_inner_node(std::uint32_t step, const Check& check) const {
    for (int level = 1; level <= octree_.depth(); ++level) {
      for (std::uint32_t node = 0; node < octree_.node_count(level); node += step) {
        SCOPED_TRACE("level " + std::to_string(level) + ", node " + std::to_string(node));
        std::uint32_t first = node, end = node + 1;
        for (int below = level; below > 0; --below) {
          first = octree_.nodes(below)[first].first_child;
          end = octree_.nodes(below)[end].first_child;
        }
        check(level, bound(level, node), first, end);
        if (::testing::Test::HasFatalFailure()) return;
      }
    }
  }

 private:
  VoxelSet voxels_;
  LinearOctree octree_;
  BoundBlocks bounds_;
  std::vector<ExactBound> leaves_;
};

// The partner radii for which a slab must hold as it is, from almost none, and beyond them with the
// rise.
void expect_nested(const Nested& tree, std::uint32_t step = 1) {
  ASSERT_GT(tree.octree().depth(), 0);
  const mpq_class built(kPartnerRadius), rise(kPartnerRise);
  tree.each_inner_node(
      step, [&](int, const ExactBound& node, std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t leaf = first; leaf < end; ++leaf) {
          const ExactBound& own = tree.leaves()[leaf];
          ASSERT_TRUE(test::holds_ball(node, own)) << "leaf " << leaf;
          for (const double partner_radius : {0x1p-20, 0.2, 0.6, 1.0, kPartnerRadius}) {
            ASSERT_TRUE(test::is_nested(node, own, partner_radius))
                << "leaf " << leaf << ", partner radius " << partner_radius;
          }
          for (const double partner_radius : {1.5, 2.5, 8.0, 100.0}) {
            ASSERT_TRUE(test::is_nested(node, own, partner_radius, rise * (partner_radius - built)))
                << "leaf " << leaf << ", partner radius " << partner_radius;
          }
        }
      });
}

TEST(NestedBounds, HoldTheirLeavesOfASphere) { expect_nested({test::icosphere(2, 1), 0.17}); }

TEST(NestedBounds, HoldTheirLeavesOfABoxOnThePlanesOfTheGrid) {
  expect_nested({test::box({0, 0, 0}, {5, 3, 2}), 1});
  expect_nested({test::box({0.1, 0.2, 0.3}, {0.9, 0.6, 0.5}), 0.1});
}

TEST(NestedBounds, HoldTheirLeavesOfAFlatPatch) {
  expect_nested({test::open_strip(3), 0.3});
  expect_nested({test::triangle({0, 0, 0}, {3, 0.4, 1}, {1, 3, 0.9}), 0.2});
}

TEST(NestedBounds, HoldTheirLeavesOfRandomTrianglesSliversSegmentsAndPoints) {
  test::Random random(1);
  for (int round = 0; round < test::samples(6); ++round) {
    TriangleMesh mesh;
    for (int i = 0; i < 12; ++i) {
      const Vector3d a = random.point(-1, 1), b = random.point(-1, 1), c = random.point(-1, 1);
      const Vector3d between = a + random.uniform(0, 1) * (b - a);
      const Vector3d third[] = {c, between, between + 1e-6 * c, a};
      mesh = test::joined(mesh, test::triangle(a, i % 6 == 5 ? a : b, third[i % 4]));
    }
    expect_nested({mesh, 0.15}, 3);
  }
}

TEST(NestedBounds, HoldTheirLeavesOfAJaw) { expect_nested({make_jaw(Jaw::kUpper, 1), 2}, 7); }

TEST(NestedBounds, HoldTheirLeavesFarFromTheOrigin) {
  expect_nested({test::moved(test::icosphere(1, 1), {1e6, -1e6, 1e6}), 0.21});
}

// Two leaves and nothing between them: balls and slabs of every level up to the root of 65,536
// cells, whose pad is twice the unit of a leaf's ball.
TEST(NestedBounds, HoldTheirLeavesOnTheFinestGrid) {
  const Vector3d small(0x1p-15, 0, 0x1p-17);
  expect_nested({test::joined(test::triangle({0, 0, 0}, small, {0, 0x1p-15, 0}),
                              test::triangle({1, 1, 1}, {1, 1, 1 - 0x1p-16}, {1, 1 - 0x1p-15, 1})),
                 0x1p-16});
}

// Points of the leaves' balls, on the side away from the ball's centre: no ball that holds the
// leaves is smaller than theirs.
TEST(NestedBounds, AreBallsThatAreHardlyLargerThanTheSmallest) {
  for (const Nested& tree : {Nested(test::icosphere(2, 1), 0.17),
                             Nested(test::box({0.1, 0.2, 0.3}, {0.9, 0.6, 0.5}), 0.1)}) {
    tree.each_inner_node(
        1, [&](int level, const ExactBound& node, std::uint32_t first, std::uint32_t end) {
          std::vector<ExactPoint> points;
          const double radius = node.radius.get_d();
          for (std::uint32_t leaf = first; leaf < end; ++leaf) {
            const ExactBound& own = tree.leaves()[leaf];
            const double distance = std::sqrt(test::square(own.centre - node.centre).get_d());
            if (distance + own.radius.get_d() < 0.9 * radius) continue;
            const double out = distance > 0 ? own.radius.get_d() * (1 - 1e-12) / distance : 0;
            points.push_back(own.centre + mpq_class(out) * (own.centre - node.centre));
          }
          ASSERT_FALSE(points.empty());
          if (end - first == 1) {
            ASSERT_LE(node.radius, tree.leaves()[first].radius + std::ldexp(4.0, level - 15));
            return;
          }
          const double smallest = std::sqrt(test::smallest_ball(points).radius_squared.get_d());
          ASSERT_LE(radius, 1.005 * smallest * (1 + 1e-9) + std::ldexp(3.0, level - 15));
        });
  }
}

// Nested for its partner radius, the slab of a plane is as thin as the leaves', but for what its
// rounded normal tilts and what a leaf's normal is shorter.
TEST(NestedBounds, OfAFlatPatchAreThin) {
  const Nested tree(test::open_strip(3), 0.3);
  tree.each_inner_node(1, [&](int level, const ExactBound& node, std::uint32_t, std::uint32_t) {
    EXPECT_LE(node.half, 0.05 + std::ldexp(2.0, level - 8));
    EXPECT_GT(abs(node.normal[2]), 0.98);
  });
}

TEST(NestedBounds, AreRoundedUpByOneUnitAtMost) {
  const Nested tree(test::icosphere(2, 1), 0.17);
  std::size_t tight = 0, nodes = 0;
  tree.each_inner_node(1, [&](int level, ExactBound node, std::uint32_t first, std::uint32_t end) {
    const mpq_class unit = mpq_class(std::uint64_t{1} << level) / 32768;
    node.radius -= 2 * unit;
    bool holds_all = true;
    for (std::uint32_t leaf = first; leaf < end; ++leaf) {
      holds_all = holds_all && test::holds_ball(node, tree.leaves()[leaf]);
    }
    ASSERT_FALSE(holds_all);
    // Half a unit of the offset and one of the width; and by no shorter normal's partner radius.
    node.half -= mpq_class(8, 256) * (std::uint64_t{1} << level) / 4;
    bool nested = true;
    for (std::uint32_t leaf = first; leaf < end && nested; ++leaf) {
      nested = test::is_nested(node, tree.leaves()[leaf], mpq_class(kPartnerRadius));
    }
    tight += nested ? 0 : 1;
    ++nodes;
  });
  EXPECT_GT(tight, nodes * 9 / 10);
}

}  // namespace
}  // namespace ist
