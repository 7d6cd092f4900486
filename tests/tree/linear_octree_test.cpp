#include "ist/tree/linear_octree.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>
#include <tuple>
#include <vector>

#include "ist/tree/implicit_ball.h"
#include "ist/tree/lookup_table.h"
#include "ist/voxel/morton.h"
#include "support/exact.h"
#include "support/random.h"

namespace ist {
namespace {

using Codes = std::vector<std::uint64_t>;
using Masks = std::vector<std::vector<std::uint8_t>>;

Codes random_codes(test::Random& random, int depth, std::size_t count) {
  std::set<std::uint64_t> codes;
  const std::uint64_t end = std::uint64_t{1} << 3 * depth;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t code = random.bits() % end;
    codes.insert({code, code ^ random.below(64) % end});  // siblings and cousins too
  }
  return {codes.begin(), codes.end()};
}

Masks masks_of(const LinearOctree& octree) {
  Masks masks;
  for (int level = 1; level <= octree.depth(); ++level) {
    masks.emplace_back(octree.masks(level).begin(), octree.masks(level).end());
  }
  return masks;
}

void expect_the_tree_of(const LinearOctree& octree, const Codes& leaves, int depth) {
  ASSERT_EQ(octree.depth(), depth);
  EXPECT_EQ(octree.leaf_count(), leaves.size());
  std::set<std::uint64_t> below(leaves.begin(), leaves.end());
  EXPECT_EQ(octree.codes(0), leaves);
  std::uint64_t nodes = leaves.size();
  for (int level = 1; level <= depth; ++level) {
    std::set<std::uint64_t> parents;
    for (const std::uint64_t code : below) parents.insert(code / 8);
    ASSERT_EQ(octree.node_count(level), parents.size());
    ASSERT_EQ(octree.masks(level).size(), parents.size());
    for (std::size_t i = 0; i < LinearOctree::kMaskSpare; ++i) {
      ASSERT_EQ(octree.masks(level).data()[parents.size() + i], 0);  // there, if no mask
    }
    ASSERT_EQ(octree.codes(level), Codes(parents.begin(), parents.end()));
    ASSERT_EQ(octree.nodes(level).size(), parents.size() + 1);
    ASSERT_EQ(octree.nodes(level).back().first_child, below.size());
    std::uint32_t node = 0;
    for (const std::uint64_t parent : parents) {
      const auto first = below.lower_bound(parent * 8), end = below.lower_bound(parent * 8 + 8);
      unsigned mask = 0;
      for (auto child = first; child != end; ++child) mask |= 1u << (*child - parent * 8);
      ASSERT_EQ(octree.mask(level, node), mask);
      ASSERT_EQ(octree.first_child(level, node), std::distance(below.begin(), first));
      ASSERT_EQ(octree.nodes(level)[node].first_child, octree.first_child(level, node));
      ASSERT_EQ(octree.child_count(level, node), std::popcount(mask));
      const Cell cell = morton_decode(parent);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // In half leaf edges, all is integer.
        const std::int64_t edge = std::int64_t{2} << level, root = std::int64_t{1} << depth;
        const std::int64_t centre = cell[axis] * edge + edge / 2 - root;
        ASSERT_EQ(2 * double{octree.nodes(level)[node].centre[axis]}, static_cast<double>(centre));
      }
      ++node;
    }
    nodes += parents.size();
    below = parents;
  }
  EXPECT_EQ(below, std::set<std::uint64_t>{0});
  EXPECT_EQ(octree.node_count(), nodes);
  ASSERT_EQ(octree.nodes(depth + 1).size(), 2u);
  const OctreeNode above = octree.nodes(depth + 1)[0];
  EXPECT_TRUE(above.centre[0] == 0 && above.centre[1] == 0 && above.centre[2] == 0);
  EXPECT_EQ(above.first_child, 0u);
  EXPECT_EQ(octree.child_count(depth + 1, 0), 1);
}

TEST(LinearOctree, HasTheParentsOfItsLeavesAndNoOthers) {
  test::Random random(1);
  for (int depth = 1; depth <= 17; ++depth) {
    for (const std::size_t count : {1u, 10u, 300u}) {
      const Codes leaves = random_codes(random, depth, count);
      expect_the_tree_of(LinearOctree(leaves, depth), leaves, depth);
    }
  }
}

TEST(LinearOctree, OfOneVoxelIsALeafAndNothingElse) {
  const LinearOctree octree(Codes{0}, 0);
  expect_the_tree_of(octree, {0}, 0);
  expect_the_tree_of(LinearOctree(Masks{}), {0}, 0);
  EXPECT_EQ(octree.node_count(), 1u);
}

TEST(LinearOctree, FullLevelsHaveAllCodes) {
  Codes leaves(512);
  for (std::size_t i = 0; i < leaves.size(); ++i) leaves[i] = i;
  expect_the_tree_of(LinearOctree(leaves, 3), leaves, 3);
}

TEST(LinearOctree, FollowsFromItsMasks) {
  test::Random random(2);
  for (int depth = 0; depth <= 16; ++depth) {
    const Codes leaves = depth == 0 ? Codes{0} : random_codes(random, depth, 200);
    const LinearOctree octree(leaves, depth);
    const Masks masks = masks_of(octree);
    ASSERT_TRUE(LinearOctree::is_tree(masks));
    expect_the_tree_of(LinearOctree(masks), leaves, depth);
  }
}

TEST(LinearOctree, MasksThatAreNoTreeAreKnown) {
  const Masks masks{{0x81, 0x01, 0xFF}, {0x03, 0x10}, {0x05}};  // 11 leaves, then 3, 2, 1
  ASSERT_TRUE(LinearOctree::is_tree(masks));
  const auto is_tree_with = [&](auto change) {
    Masks changed = masks;
    change(changed);
    return LinearOctree::is_tree(changed);
  };
  EXPECT_FALSE(is_tree_with([](Masks& m) { m[0][1] = 0; })) << "a leaf's parent without children";
  EXPECT_FALSE(is_tree_with([](Masks& m) { m[2][0] = 0; })) << "a root without children";
  EXPECT_FALSE(is_tree_with([](Masks& m) { m[1][0] = 0x07; })) << "more children than nodes";
  EXPECT_FALSE(is_tree_with([](Masks& m) { m[1][0] = 0x01; })) << "fewer children than nodes";
  EXPECT_FALSE(is_tree_with([](Masks& m) { m[0].push_back(1); })) << "a node without a parent";
  EXPECT_FALSE(is_tree_with([](Masks& m) { m[0].pop_back(); })) << "a node missing";
  EXPECT_FALSE(is_tree_with([](Masks& m) { m[2].push_back(1); })) << "two roots";
  EXPECT_FALSE(is_tree_with([](Masks& m) { m[2].clear(); })) << "no root";
  EXPECT_FALSE(is_tree_with([](Masks& m) { m[1].clear(); })) << "an empty level";
  EXPECT_FALSE(is_tree_with([](Masks& m) { m.pop_back(); })) << "no common root";
  EXPECT_TRUE(is_tree_with([](Masks& m) { m[0][0] = 0x42; })) << "other leaves are another tree";
}

using test::ExactPoint;

// The corners of the children's cubes, in units of a sixth of the node's half edge.
std::vector<ExactPoint> corners(unsigned mask) {
  std::vector<ExactPoint> corners;
  for (int octant = 0; octant < 8; ++octant) {
    if ((mask >> octant & 1) == 0) continue;
    for (int corner = 0; corner < 8; ++corner) {
      ExactPoint p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool upper = (octant >> axis & 1) != 0, end = (corner >> axis & 1) != 0;
        p[axis] = (upper ? 0 : -6) + (end ? 6 : 0);
      }
      corners.push_back(p);
    }
  }
  return corners;
}

TEST(LookupTable, HoldsTheSmallestBallOfEachMask) {
  for (unsigned mask = 1; mask < 256; ++mask) {
    const TableBall& ball = kLookupTable[mask];
    const test::ExactBall smallest = test::smallest_ball(corners(mask));
    EXPECT_EQ(ball.x, smallest.centre[0]) << mask;
    EXPECT_EQ(ball.y, smallest.centre[1]) << mask;
    EXPECT_EQ(ball.z, smallest.centre[2]) << mask;
    EXPECT_EQ(ball.radius_squared, smallest.radius_squared) << mask;
  }
}

TEST(LookupTable, HasFewDistinctBallsAndRadii) {
  std::set<std::tuple<int, int, int, int>> balls;
  std::set<int> radii;
  int smaller = 0;
  for (unsigned mask = 1; mask < 256; ++mask) {
    const TableBall& ball = kLookupTable[mask];
    balls.insert({ball.x, ball.y, ball.z, ball.radius_squared});
    radii.insert(ball.radius_squared);
    smaller += ball.radius_squared < 108;
    EXPECT_TRUE(std::popcount(mask) < 5 || ball.radius_squared == 108) << mask;
  }
  EXPECT_EQ(balls.size(), 35u);
  EXPECT_EQ(radii, (std::set<int>{27, 54, 81, 96, 108}));
  EXPECT_EQ(smaller, 78);
}

TEST(LookupTable, ANodeWithoutChildrenIsAPoint) { EXPECT_EQ(kLookupTable[0], TableBall{}); }

TEST(TableRadii, AreTheSquareRootsRoundedUp) {
  for (std::size_t code = 0; code < kTableRadii.size(); ++code) {
    const mpq_class expected(kTableSquares[code], 36);
    const mpq_class radius(kTableRadii[code]);
    const mpq_class below(std::nextafter(kTableRadii[code], 0.0));
    EXPECT_GE(radius * radius, expected) << code;
    EXPECT_LT(below * below, expected) << code;
  }
  EXPECT_EQ(kTableRadii[kCircumsphereCode], kSqrt3);
}

}  // namespace
}  // namespace ist
