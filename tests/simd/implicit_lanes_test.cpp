// The implicit balls of every occupancy mask at every level: the scalar form against double, and
// each vector form against the scalar one, bit for bit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "ist/query/traversal/search_plan.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_parts.h"
#include "simd/guarded.h"
#include "simd/lanes.h"
#include "simd/plan_cases.h"
#include "simd/targets.h"

namespace ist::test {
namespace {

// Depth 5; the nodes at level 2 have all masks, and their children too.
const SphereTree& tree_of_all_masks() {
  static const SphereTree tree = [] {
    std::vector<std::vector<std::uint8_t>> masks(5);
    std::size_t nodes = 1;
    for (std::size_t level = 5; level >= 1; --level) {
      std::vector<std::uint8_t>& here = masks[level - 1];
      for (std::size_t i = 0; i < nodes; ++i) {
        here.push_back(level > 2 ? 255 : static_cast<std::uint8_t>(1 + i % 255));
      }
      nodes = 0;
      for (const std::uint8_t mask : here) nodes += static_cast<unsigned>(std::popcount(mask));
    }
    return tree_from({TreeVoxels{Lattice{{0, 0, 0}, 0.3, 32, 5}, LinearOctree(std::move(masks)),
                                 std::vector<PackedNormal>(nodes)},
                      std::nullopt, Orientation::kOutward});
  }();
  return tree;
}

// Calls `body(step, side, level, parent, first child)` for every parent of the tree, as moving node
// of a step.
template <class Body>
void for_each_parent(SpherePolicy policy, const Body& body) {
  const SphereTree& tree = tree_of_all_masks();
  const SearchPlan plan(tree, tree, policy);
  for (int level = tree.depth() - 1; level >= 0; --level) {
    const SearchStep& step = plan.steps()[static_cast<std::size_t>(tree.depth() - 1 - level)];
    const std::uint32_t children = voxels_of(tree).octree.node_count(level);
    std::uint32_t child = 0;
    for (std::uint32_t parent = 0; child < children; ++parent) {
      body(step, level, parent, child);
      child += child_count(step.moving, parent);
    }
  }
}

TEST(ImplicitLanes, AreTheNestedBallsRoundedUp) {
  const TreeVoxels& voxels = voxels_of(tree_of_all_masks());
  for (const SpherePolicy policy : {SpherePolicy::kSimple, SpherePolicy::kTable}) {
    const auto lanes = std::make_unique<MovingLanes>();
    int codes_of = -1;
    std::vector<std::uint64_t> codes;
    for_each_parent(
        policy, [&](const SearchStep& step, int level, std::uint32_t parent, std::uint32_t first) {
          if (codes_of != level) codes = voxels.octree.codes(codes_of = level);
          const std::uint32_t count = decode(step.moving, parent, *lanes, 3);
          for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t child = first + i;
            ASSERT_EQ(lanes->id[3 + i], child);
            const Ball ball = voxels.nested_ball(policy, level, child,
                                                 cube_centre(voxels.lattice, level, codes[child]));
            ASSERT_GE(double{lanes->lane[kRadius][3 + i]}, ball.radius);
            ASSERT_LE(double{lanes->lane[kRadius][3 + i]}, ball.radius * (1 + 0x1p-23));
            for (const Lane lane : {kX, kY, kZ}) {
              ASSERT_NEAR(double{lanes->lane[lane][3 + i]},
                          ball.centre[static_cast<Eigen::Index>(lane)],
                          0x1p-22 * tree_of_all_masks().bounding_radius());
            }
          }
        });
  }
}

class ImplicitLanes : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Targets, ImplicitLanes, ::testing::ValuesIn(vector_targets()), name_of);

// A pad brings each child within some last bits of the border to a fixed node.
TEST_P(ImplicitLanes, AreTheScalarFormOfEveryMask) {
  const Kernels& kernels = select_kernels(GetParam());
  const auto scratch = std::make_unique<SearchScratch>();
  Random random(6);
  int overlapping = 0, separate = 0;
  for (const SpherePolicy policy : {SpherePolicy::kSimple, SpherePolicy::kTable}) {
    for_each_parent(policy, [&](const SearchStep& of, int, std::uint32_t parent, std::uint32_t) {
      SearchStep step = of;
      step.moving.emits_slots = random.below(2) == 0;
      GuardedFrontier in(1, 0), wanted(64, 0), made(64, 0);
      in.append(0, std::vector<std::uint32_t>{parent});
      for (std::uint32_t child = 0; child < child_count(step.moving, parent); ++child) {
        SearchPose pose = random_pose(random, 0);
        decode(step.fixed, 0, scratch->fixed[0].lanes, 0);
        decode(step.moving, parent, scratch->moving, 0);
        turn(pose, pose.leaf, false, scratch->fixed[0].lanes, 0, scratch->fixed[0].rows);
        const PairTest test(scratch->fixed[0].rows, 0, scratch->moving, child, false);
        pose.leaf.ball = (std::sqrt(test.squared) - test.radius_sum) *
                         (1 + 0x1p-23F * (static_cast<float>(random.below(5)) - 2));
        pose.inner = pose.leaf;
        turn(pose, pose.leaf, false, scratch->fixed[0].lanes, 0, scratch->fixed[0].rows);
        const PairTest border(scratch->fixed[0].rows, 0, scratch->moving, child, false);
        ++(border.overlap() ? overlapping : separate);
        wanted.clear();
        made.clear();
        SearchCursor wanted_cursor, cursor;
        DistanceBounds wanted_bounds, bounds;
        constexpr std::uint64_t kAll = ~std::uint64_t{0};
        advance_scalar(step, pose, in, wanted_cursor, wanted, *scratch, kAll, Measured::kBoth,
                       wanted_bounds);
        kernels.advance(step, pose, in, cursor, made, *scratch, kAll, Measured::kBoth, bounds);
        ASSERT_TRUE(same_pairs(made, wanted));
        ASSERT_EQ(bounds.lower, wanted_bounds.lower);
        ASSERT_EQ(bounds.upper, wanted_bounds.upper);
      }
    });
  }
  EXPECT_GT(overlapping, 5'000);
  EXPECT_GT(separate, 5'000);
}

}  // namespace
}  // namespace ist::test
