#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "ist/hardware/pair_test.h"
#include "ist/hardware/quantized_pose.h"
#include "ist/query/query_rules.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

namespace ist::test {

/// A node as a tree has it: its cube's centre in units of its own tree.
struct HardwareNode {
  std::array<std::int32_t, 3> centre{};
  int level = 0;
  std::uint8_t mask = 255;
};

/// The circuit's input for two nodes.
[[nodiscard]] inline NodePair node_pair(const QuantizedPose& pose, const HardwareNode& fixed,
                                        const HardwareNode& moving) noexcept {
  NodePair pair;
  pair.fixed_centre = fixed.centre;
  pair.fixed_level = static_cast<std::uint8_t>(fixed.level);
  pair.fixed_mask = fixed.mask;
  pair.moving_centre = move_centre(pose, moving.centre);
  pair.moving_level = static_cast<std::uint8_t>(moving.level);
  pair.moving_mask = moving.mask;
  return pair;
}

/// The way of a query down two trees, as a unit round the circuit would go it: the reference's,
/// with each pair of nodes decided by `touch(fixed, moving)`, two HardwareNodes.
template <typename FoundPairs>
class PairWalk {
 public:
  /// Counted while it goes.
  struct Counts {
    std::uint64_t tested = 0;      ///< pairs
    std::uint64_t leaf_pairs = 0;  ///< pairs of leaves that touch
    std::uint64_t opened = 0;      ///< pairs whose children were read
    std::uint64_t words = 0;       ///< read: a node's mask and first child, of inner nodes only
    std::uint64_t moved = 0;       ///< centres that went through the mover
  };

  PairWalk(const SphereTree& fixed, const SphereTree& moving, FoundPairs touch)
      : fixed_(fixed), moving_(moving), touch_(touch) {}

  [[nodiscard]] Counts run() {
    counts_ = {};
    const Node a = root(fixed_), b = root(moving_);
    counts_.words = 2;
    counts_.moved = 1;
    test(a, b);
    return counts_;
  }

 private:
  struct Node {
    HardwareNode seen;
    std::uint32_t index;
  };
  struct Children {
    int count = 0;
    std::array<Node, 8> nodes;
  };

  static Node root(const SphereTree& tree) {
    return {{{},
             tree.depth(),
             tree.depth() == 0 ? std::uint8_t{255} : voxels_of(tree).octree.mask(tree.depth(), 0)},
            0};
  }

  Children open(const SphereTree& tree, const Node& node) {
    const int level = node.seen.level - 1;
    Children children;
    std::uint32_t index = voxels_of(tree).octree.first_child(level + 1, node.index);
    for (unsigned bits = node.seen.mask; bits != 0; bits &= bits - 1) {
      const int k = std::countr_zero(bits);
      Node& child = children.nodes[static_cast<std::size_t>(children.count++)];
      child = {node.seen, index++};
      child.seen.level = level;
      child.seen.mask =
          level == 0 ? std::uint8_t{255} : voxels_of(tree).octree.mask(level, child.index);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        child.seen.centre[axis] += (k >> axis & 1) != 0 ? 6 << level : -(6 << level);
      }
    }
    if (level > 0) counts_.words += static_cast<std::uint64_t>(children.count);
    return children;
  }

  void test(const Node& a, const Node& b) {
    ++counts_.tested;
    if (!touch_(a.seen, b.seen)) return;
    if (a.seen.level == 0 && b.seen.level == 0) {
      ++counts_.leaf_pairs;
      return;
    }
    ++counts_.opened;
    const double edge_a = voxels_of(fixed_).lattice.edge(a.seen.level);
    const double edge_b = voxels_of(moving_).lattice.edge(b.seen.level);
    Children of_a{1, {a}}, of_b{1, {b}};
    if (descends(a.seen.level, edge_a, b.seen.level, edge_b)) of_a = open(fixed_, a);
    if (descends(b.seen.level, edge_b, a.seen.level, edge_a)) {
      of_b = open(moving_, b);
      counts_.moved += static_cast<std::uint64_t>(of_b.count);
    }
    for (int i = 0; i < of_a.count; ++i) {
      for (int j = 0; j < of_b.count; ++j) {
        test(of_a.nodes[static_cast<std::size_t>(i)], of_b.nodes[static_cast<std::size_t>(j)]);
      }
    }
  }

  const SphereTree& fixed_;
  const SphereTree& moving_;
  FoundPairs touch_;
  Counts counts_;
};

}  // namespace ist::test
