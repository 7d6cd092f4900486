#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ist {

/// A node above the leaves, in the layout for searches.
struct OctreeNode {
  float centre[3];  ///< centre of the cube, in leaf edges from the root cube's centre: exact
  std::uint32_t first_child;  ///< the first child's index at the level below
};
static_assert(sizeof(OctreeNode) == 16);

/// A linear octree: one array a level, in Morton order. A node at level L >= 1 is an occupancy
/// mask, its cube's centre and the index, at level L - 1, of its first child; siblings are
/// contiguous. Empty space has no node, and a leaf (level 0) is only its index.
///
/// Memory: 17 bytes a node above the leaves, 6 bytes a leaf on a surface.
class LinearOctree {
 public:
  /// Builds the octree from its leaves upwards. `leaf_codes` are Morton codes, ascending, below
  /// 8^depth, at least one and fewer than 2^32.
  /// Cost: O(leaves).
  LinearOctree(std::span<const std::uint64_t> leaf_codes, int depth);

  /// Builds the octree from its masks, `of_levels[L - 1]` for level L; their number is the depth.
  /// Precondition: is_tree(of_levels).
  explicit LinearOctree(std::vector<std::vector<std::uint8_t>> of_levels);

  /// Whether the masks describe a tree: each mask holds a child, the top level is one node, and
  /// each level has as many nodes as the level above has children, fewer than 2^32.
  [[nodiscard]] static bool is_tree(std::span<const std::vector<std::uint8_t>> masks) noexcept;

  [[nodiscard]] int depth() const noexcept { return static_cast<int>(masks_.size()); }
  [[nodiscard]] std::uint32_t leaf_count() const noexcept { return nodes_[0].back().first_child; }
  [[nodiscard]] std::uint32_t node_count(int level) const noexcept {
    return level == 0 ? leaf_count() : static_cast<std::uint32_t>(masks(level).size());
  }

  /// The number of nodes of all levels, leaves included.
  [[nodiscard]] std::uint64_t node_count() const noexcept;

  /// The nodes at `level`, 1 … depth, and an end node, whose first child is where the last node's
  /// children end. Level depth + 1 holds the root's parent, whose only child is the root, and whose
  /// cube has the root's centre and twice its edge.
  [[nodiscard]] std::span<const OctreeNode> nodes(int level) const noexcept {
    return nodes_[index(level)];
  }
  /// The number of children of a node at `level`, 1 … depth + 1.
  [[nodiscard]] int child_count(int level, std::uint32_t node) const noexcept {
    const std::span<const OctreeNode> here = nodes(level);
    return static_cast<int>(here[node + 1].first_child - here[node].first_child);
  }
  /// The occupancy mask of a node at `level` >= 1: bit k is set if child k exists.
  [[nodiscard]] std::uint8_t mask(int level, std::uint32_t node) const noexcept {
    return masks_[index(level)][node];
  }
  /// The index of the first child of a node at `level` >= 1. Child k has the index first_child +
  /// popcount(mask below k).
  [[nodiscard]] std::uint32_t first_child(int level, std::uint32_t node) const noexcept {
    return nodes_[index(level)][node].first_child;
  }
  /// The masks of the nodes at `level` >= 1. kMaskSpare bytes behind them may be read, as the
  /// vector form of a decode does.
  [[nodiscard]] std::span<const std::uint8_t> masks(int level) const noexcept {
    return std::span(masks_[index(level)]).first(masks_[index(level)].size() - kMaskSpare);
  }
  static constexpr std::size_t kMaskSpare = 7;

  /// Returns the Morton codes of the nodes at `level`, ascending. Cost: O(nodes above and at the
  /// level).
  [[nodiscard]] std::vector<std::uint64_t> codes(int level) const;

  /// The size in memory, bytes.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  static std::size_t index(int level) noexcept { return static_cast<std::size_t>(level - 1); }

  std::vector<std::vector<std::uint8_t>> masks_;  // level 1 first, kMaskSpare zeros behind each
  std::vector<std::vector<OctreeNode>> nodes_;    // level 1 first, the root's parent last
};

}  // namespace ist
