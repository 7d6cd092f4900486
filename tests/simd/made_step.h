#pragma once

#include <cstdint>
#include <vector>

#include "query/query_cases.h"
#include "simd/guarded.h"
#include "simd/step.h"

namespace ist::test {

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

}  // namespace ist::test
