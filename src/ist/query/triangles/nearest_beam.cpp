#include "ist/query/triangles/nearest_beam.h"

#include <algorithm>

namespace ist {
namespace {

using NodePair = NearestBeam::NodePair;

// The best pairs so far, best first; of equal ones the earlier.
struct Best {
  std::array<NodePair, kBeamWidth> pairs{};
  std::size_t count = 0;

  void add(const NodePair& pair) noexcept {
    if (count == kBeamWidth && !(pair.score < pairs[count - 1].score)) return;
    std::size_t at = count < kBeamWidth ? count++ : count - 1;
    for (; at > 0 && pair.score < pairs[at - 1].score; --at) pairs[at] = pairs[at - 1];
    pairs[at] = pair;
  }
};

}  // namespace

NearestBeam::NearestBeam(const TriangleClusters& fixed, const TriangleClusters& moving,
                         const ClusterKernels& kernels, const ClusterPose& pose,
                         BudgetMeter& meter) noexcept {
  int fixed_level = fixed.root_level(), moving_level = moving.root_level();
  Best best;
  best.add({0, 0, 0});
  TurnedBlock turned;
  alignas(64) float scores[kClusterWidth];
  while (fixed_level > 0 || moving_level > 0) {
    const bool fixed_goes = fixed_level >= moving_level, moving_goes = moving_level >= fixed_level;
    Best next;
    for (std::size_t k = 0; k < best.count; ++k) {
      const NodePair pair = best.pairs[k];
      // A tree that stays has its node's siblings beside the node.
      const std::uint32_t moving_block = moving_goes ? pair.moving : pair.moving / kClusterWidth;
      const std::uint32_t fixed_block = fixed_goes ? pair.fixed : pair.fixed / kClusterWidth;
      const int below_moving = moving_level - (moving_goes ? 1 : 0);
      const int below_fixed = fixed_level - (fixed_goes ? 1 : 0);
      kernels.turn_nodes(moving.bounds(below_moving)[moving_block], pose, turned);
      for (std::uint32_t m = 0; m < moving.child_count(below_moving, moving_block); ++m) {
        const std::uint32_t moving_node = kClusterWidth * moving_block + m;
        if (!moving_goes && moving_node != pair.moving) continue;
        if (!meter.allows(kClusterWidth)) return;
        meter.spend(kClusterWidth);
        kernels.score_children(turned, m, fixed.bounds(below_fixed)[fixed_block], scores);
        for (std::uint32_t f = 0; f < fixed.child_count(below_fixed, fixed_block); ++f) {
          const std::uint32_t fixed_node = kClusterWidth * fixed_block + f;
          if (!fixed_goes && fixed_node != pair.fixed) continue;
          next.add({fixed_node, moving_node, scores[f]});
        }
      }
    }
    best = next;
    fixed_level -= fixed_goes ? 1 : 0;
    moving_level -= moving_goes ? 1 : 0;
  }
  pairs_ = best.pairs;
  count_ = best.count;
}

}  // namespace ist
