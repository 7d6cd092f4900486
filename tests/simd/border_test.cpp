#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "query/query_cases.h"
#include "simd/guarded.h"
#include "simd/lanes.h"
#include "simd/plan_cases.h"
#include "simd/step.h"
#include "simd/targets.h"
#include "support/effort.h"

namespace ist::test {
namespace {

/// A step between nodes that no tree has: one fixed parent with eight children, and some moving
/// parents with one to eight. The test sets the numbers of the blocks and the units.
class MadeStep {
 public:
  MadeStep(std::size_t moving_parents, bool slabs, Random& random)
      : fixed_(1), moving_(moving_parents), in_(moving_parents, 0) {
    fill(fixed_, 8, random);
    fill(moving_, 0, random);
    step = {side(fixed_, slabs), side(moving_, slabs), random.below(2) == 0, true, 0x1p18F};
    std::vector<std::uint32_t> all(moving_parents);
    for (std::uint32_t i = 0; i < moving_parents; ++i) all[i] = i;
    in_.append(0, all);
  }
  MadeStep(const MadeStep&) = delete;
  MadeStep& operator=(const MadeStep&) = delete;

  [[nodiscard]] const Frontier& in() const { return in_; }
  [[nodiscard]] std::size_t most_pairs() const { return 64 * moving_.balls.size(); }

  /// Calls `set(node, ball, slab)` for every parent.
  template <class Set>
  void for_each(const Set& set) {
    for (Side* side : {&fixed_, &moving_}) {
      for (std::size_t i = 0; i < side->balls.size(); ++i) {
        set(side->nodes[i], side->balls[i], side->slabs[i]);
      }
    }
  }

  SearchStep step{};

 private:
  struct Side {
    explicit Side(std::size_t parents)
        : nodes(parents + 1), balls(parents), slabs(parents), masks(parents, 255) {}
    std::vector<OctreeNode> nodes;
    std::vector<BallBlock> balls;
    std::vector<SlabBlock> slabs;
    std::vector<std::uint8_t> masks;
  };
  static void fill(Side& side, std::uint32_t children, Random& random) {
    std::uint32_t first = 0;
    for (OctreeNode& node : side.nodes) {
      node.first_child = first;
      first += children > 0 ? children : 1 + static_cast<std::uint32_t>(random.below(8));
    }
  }
  static SearchSide side(const Side& of, bool slabs) {
    SearchSide side{};
    side.nodes = of.nodes.data();
    side.balls = of.balls.data();
    side.slabs = slabs ? of.slabs.data() : nullptr;
    side.masks = of.masks.data();
    side.voxel_size = side.ball_unit = side.slab_unit = 1;
    side.descends = true;
    return side;
  }

  Side fixed_, moving_;
  GuardedFrontier in_;
};

// Pairs of bounds at the border between overlapping and separate: each vector kernel against the
// scalar form, which specifies it.

class Border : public ::testing::TestWithParam<std::string> {
 protected:
  // Returns how many pairs overlap.
  std::size_t expect_same(const MadeStep& made, const SearchPose& pose) {
    std::size_t found = 0;
    for (const Measured measured : {Measured::kNothing, Measured::kUpper, Measured::kBoth}) {
      GuardedFrontier wanted(made.most_pairs(), 0), out(made.most_pairs(), 3);
      SearchCursor wanted_cursor, cursor;
      DistanceBounds wanted_bounds, bounds;
      const Advanced tests = advance_scalar(made.step, pose, made.in(), wanted_cursor, wanted,
                                            *scratch_, kAll, measured, wanted_bounds);
      EXPECT_EQ(
          kernels_
              .advance(made.step, pose, made.in(), cursor, out, *scratch_, kAll, measured, bounds)
              .tests,
          tests.tests);
      EXPECT_TRUE(same_pairs(out, wanted));
      EXPECT_EQ(bounds.lower, wanted_bounds.lower);
      EXPECT_EQ(bounds.upper, wanted_bounds.upper);
      found = wanted.moving_count;
    }
    return found;
  }

  static constexpr std::uint64_t kAll = ~std::uint64_t{0};
  const Kernels& kernels_ = select_kernels(GetParam());
  const std::unique_ptr<SearchScratch> scratch_ = std::make_unique<SearchScratch>();
};

INSTANTIATE_TEST_SUITE_P(Targets, Border, ::testing::ValuesIn(vector_targets()), name_of);

SearchPose identity() {
  SearchPose pose{};
  pose.rotation[0] = pose.rotation[4] = pose.rotation[8] = 1;
  return pose;
}

// Small whole numbers are tested without rounding. Many of the pairs are tangent.
TEST_P(Border, TangentBoundsOverlap) {
  Random random(3);
  std::size_t found = 0, tested = 0;
  const auto small = [&](int most) {
    return static_cast<int>(random.below(static_cast<std::size_t>(2 * most + 1))) - most;
  };
  for (int i = 0; i < samples(2000) && !HasFailure(); ++i) {
    MadeStep made(1 + random.below(9), i % 2 == 0, random);
    made.step.fixed.slab_unit = made.step.moving.slab_unit = kSlabScale;
    made.for_each([&](OctreeNode& node, BallBlock& ball, SlabBlock& slab) {
      for (float& x : node.centre) x = static_cast<float>(small(1));
      for (int slot = 0; slot < 8; ++slot) {
        const auto sign = [&] { return static_cast<std::int8_t>(-128 * (random.below(4) == 0)); };
        ball.set(slot, {static_cast<std::int16_t>(small(2)), static_cast<std::int16_t>(small(2)),
                        static_cast<std::int16_t>(small(2)),
                        static_cast<std::uint16_t>(random.below(4))});
        slab.set(slot, {sign(), sign(), sign(), static_cast<std::int8_t>(small(2)),
                        static_cast<std::uint8_t>(random.below(3))});
      }
    });
    SearchPose pose = identity();
    for (float& x : pose.translation) x = static_cast<float>(small(2));
    found += expect_same(made, pose);
    tested += made.most_pairs();
  }
  EXPECT_GT(found, tested / 50);
  EXPECT_LT(found, tested / 2);
}

// The pads bring one pair within a few last bits of its border. An operation that rounds
// differently changes the answer.
TEST_P(Border, TheLastBitDecides) {
  Random random(4);
  int overlapping = 0, separate = 0;
  for (int i = 0; i < samples(6000) && !HasFailure(); ++i) {
    const bool slabs = i % 2 == 0;
    MadeStep made(2, slabs, random);
    for (SearchSide* side : {&made.step.fixed, &made.step.moving}) {
      side->voxel_size = static_cast<float>(random.uniform(0.1, 1));
      side->ball_unit = static_cast<float>(random.uniform(1e-5, 2e-5));
      side->slab_unit = static_cast<float>(random.uniform(0.1, 0.2));
    }
    made.for_each([&](OctreeNode& node, BallBlock& ball, SlabBlock& slab) {
      for (float& x : node.centre) x = static_cast<float>(random.uniform(-1, 1));
      for (int slot = 0; slot < 8; ++slot) {
        const auto number = [&](double most) { return random.uniform(-most, most); };
        ball.set(slot, {static_cast<std::int16_t>(number(32767)),
                        static_cast<std::int16_t>(number(32767)),
                        static_cast<std::int16_t>(number(32767)),
                        static_cast<std::uint16_t>(random.below(1000))});
        slab.set(slot, {static_cast<std::int8_t>(number(70)), static_cast<std::int8_t>(number(70)),
                        static_cast<std::int8_t>(number(70)), static_cast<std::int8_t>(number(127)),
                        static_cast<std::uint8_t>(random.below(20))});
      }
    });
    SearchPose pose = random_pose(random, 0);
    decode(made.step.fixed, 0, scratch_->fixed[0].lanes, 0);
    decode(made.step.moving, 0, scratch_->moving, 0);
    turn(pose, pose.leaf, slabs, scratch_->fixed[0].lanes, 0, scratch_->fixed[0].rows);
    const PairTest test(scratch_->fixed[0].rows, 0, scratch_->moving, 0, slabs);
    const auto near = [&](float apart) {
      return apart * (1 + 0x1p-23F * (static_cast<float>(random.below(5)) - 2));
    };
    const float ball = near(std::sqrt(test.squared) - test.radius_sum);
    const float slab =
        near(random.below(2) == 0 ? test.over_fixed - test.fixed_sum
                                  : (test.over_moving - test.moving_sum) / kSlabScale);
    pose.leaf = pose.inner = {ball, slab, slab};
    expect_same(made, pose);
    turn(pose, pose.leaf, slabs, scratch_->fixed[0].lanes, 0, scratch_->fixed[0].rows);
    decode(made.step.moving, 0, scratch_->moving, 0);
    const bool overlap = PairTest(scratch_->fixed[0].rows, 0, scratch_->moving, 0, slabs).overlap();
    ++(overlap ? overlapping : separate);
  }
  EXPECT_GT(overlapping, samples(1000));
  EXPECT_GT(separate, samples(1000));
}

// Bounds are rejected by `>`, so a pair that cannot be compared is kept.
TEST_P(Border, NotANumberIsKept) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Random random(5);
  for (const bool slabs : {false, true}) {
    for (int axis = 0; axis < 3; ++axis) {
      MadeStep made(5, slabs, random);
      SearchPose pose = identity();
      pose.translation[axis] = kNan;
      const std::size_t all = 8 * made.step.moving.nodes[5].first_child;
      EXPECT_EQ(expect_same(made, pose), all);
      pose.translation[axis] = 0;
      pose.rotation[4 * axis] = kNan;
      EXPECT_EQ(expect_same(made, pose), all);
    }
  }
}

}  // namespace
}  // namespace ist::test
