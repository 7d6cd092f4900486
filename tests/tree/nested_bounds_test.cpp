#include "ist/tree/nested_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "ist/models/models.h"
#include "ist/tree/bound_blocks.h"
#include "ist/tree/bound_builder.h"
#include "ist/tree/leaf_search.h"
#include "ist/tree/linear_octree.h"
#include "ist/voxel/voxelizer.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

/// A saved bound in rational numbers, voxels from the root cube's centre.
struct ExactBound {
  ExactPoint centre;
  mpq_class radius;
  ExactPoint normal;  ///< zero without slabs
  mpq_class offset, half;
};

/// Unpacks child `slot` of `parent`, a node at `level`, from the description of the blocks.
[[nodiscard]] ExactBound exact_bound(const BoundBlocks& bounds, const LinearOctree& octree,
                                     int level, std::uint32_t parent, int slot);

/// Whether the ball of `outer` contains the ball of `inner`.
[[nodiscard]] bool holds_ball(const ExactBound& outer, const ExactBound& inner);

/// Whether normal · (x - from) is at most `limit` for all x within `partner_radius` of a bound:
/// those with |x - c| <= radius + partner radius and |n · (x - c) - offset| <= half + partner
/// radius. Decided in rational numbers; a normal of a bound, and a partner radius that leaves
/// something of the bound.
[[nodiscard]] bool stays_below(const ExactBound& bound, const mpq_class& partner_radius,
                               const ExactPoint& normal, const ExactPoint& from,
                               const mpq_class& limit);

/// Whether a slab is nested over a leaf for a partner of `partner_radius`, counting as wider by
/// `rise`.
[[nodiscard]] bool is_nested(const ExactBound& outer, const ExactBound& leaf,
                             const mpq_class& partner_radius, const mpq_class& rise = 0);

// Whether a + √b <= c, for b >= 0.
bool root_at_most(const mpq_class& b, const mpq_class& c) { return sgn(c) >= 0 && b <= c * c; }

ExactBound exact_bound(const BoundBlocks& bounds, const LinearOctree& octree, int level,
                       std::uint32_t parent, int slot) {
  const auto index = static_cast<std::size_t>(level);
  const mpq_class edge = mpq_class(std::uint64_t{1} << level);
  const PackedBall ball = bounds.balls[index][parent][slot];
  const mpq_class unit = 2 * edge / 65536;
  const int place[] = {ball.x, ball.y, ball.z};
  ExactBound bound;
  for (std::size_t i = 0; i < 3; ++i) {
    bound.centre[i] = mpq_class(octree.nodes(level + 1)[parent].centre[i]) + place[i] * unit;
  }
  bound.radius = ball.r * unit;
  if (bounds.slabs.empty()) return bound;
  const PackedSlab slab = bounds.slabs[index][parent][slot];
  bound.normal =
      mpq_class(1, 128) * ExactPoint{{mpq_class(slab.nx), mpq_class(slab.ny), mpq_class(slab.nz)}};
  bound.offset = slab.offset * edge / 256;
  bound.half = slab.half * edge / 256;
  return bound;
}

bool holds_ball(const ExactBound& outer, const ExactBound& inner) {
  return root_at_most(square(inner.centre - outer.centre), outer.radius - inner.radius);
}

// If the ball's point farthest along the normal lies beyond a face of the slab, the disc's point
// farthest along it counts: at (p · top + √((NN - p²/nn) nn (R² nn - top²))) / nn from the centre,
// with p = N · n, NN = |N|², nn = |n|², R = radius + partner radius and top = ±offset + half +
// partner radius.
bool stays_below(const ExactBound& bound, const mpq_class& partner_radius, const ExactPoint& normal,
                 const ExactPoint& from, const mpq_class& limit) {
  const mpq_class radius = bound.radius + partner_radius;
  const mpq_class squared = square(normal), own = square(bound.normal);
  const mpq_class left = limit - dot(normal, bound.centre - from);
  if (root_at_most(radius * radius * squared, left)) return true;  // the whole ball stays below
  for (const int side : {1, -1}) {
    const mpq_class along = side * dot(normal, bound.normal);
    const mpq_class top = side * bound.offset + bound.half + partner_radius;
    // Beyond this face: R p > top √NN.
    const bool beyond =
        sgn(top) >= 0 ? sgn(along) > 0 && radius * radius * along * along > top * top * squared
                      : sgn(along) >= 0 || radius * radius * along * along < top * top * squared;
    if (!beyond) continue;
    const mpq_class disc = (squared * own - along * along) * (radius * radius * own - top * top);
    return root_at_most(disc, left * own - along * top);
  }
  return false;
}

bool is_nested(const ExactBound& outer, const ExactBound& leaf, const mpq_class& partner_radius,
               const mpq_class& rise) {
  const mpq_class room = outer.half + partner_radius + rise;
  return stays_below(leaf, partner_radius, outer.normal, outer.centre, outer.offset + room) &&
         stays_below(leaf, partner_radius, mpq_class(-1) * outer.normal, outer.centre,
                     room - outer.offset);
}

}  // namespace
}  // namespace ist::test

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
      : voxels(voxelize(mesh, {.voxel_size = voxel_size, .visitor = &builder})),
        octree(voxels.codes, voxels.lattice.depth),
        bounds(builder.finish(octree)) {}

  BoundBuilder builder{SpherePolicy::kSlab};
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
      search.raise_support(normal, length, from, greatest);
      ASSERT_EQ(greatest.value, highest);
      ASSERT_EQ(height_of(greatest.bound, normal, length, from), highest);
      greatest.value = highest + 1;  // the search keeps a greater value
      search.raise_support(normal, length, from, greatest);
      ASSERT_EQ(greatest.value, highest + 1);
    }
  }
}

// Compares bounds of inner nodes with the bounds of their leaves, in rational numbers.

using test::ExactBound;
using test::ExactPoint;

class Nested {
 public:
  Nested(const TriangleMesh& mesh, double voxel_size, SpherePolicy policy = SpherePolicy::kSlab)
      : builder_(policy),
        voxels_(voxelize(mesh, {.voxel_size = voxel_size, .visitor = &builder_})),
        octree_(voxels_.codes, voxels_.lattice.depth),
        bounds_(builder_.finish(octree_)) {
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
  BoundBuilder builder_;
  VoxelSet voxels_;
  LinearOctree octree_;
  BoundBlocks bounds_;
  std::vector<ExactBound> leaves_;
};

// A slab must hold without the rise for the partner radii up to its own, and with the rise beyond.
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

// The slab of a plane, nested for its partner radius, is as thin as the leaves' slabs. The tilt of
// its rounded normal and the shorter normal of a leaf add to it.
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
