#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ist {

/// An octree flattened into one array a level, in Morton order. A node at level L >= 1 is an
/// occupancy mask and the index, at level L - 1, of its first child; siblings are contiguous. There
/// is no node for empty space, and a leaf (level 0) is nothing but its index.
///
/// 5 bytes a node above the leaves: 1.7 bytes a leaf on a surface.
class LinearOctree {
 public:
  /// Folds leaves upwards. `leaf_codes` are Morton codes, ascending, below 8^depth, at least one
  /// and fewer than 2^32. Cost: O(leaves).
  LinearOctree(std::span<const std::uint64_t> leaf_codes, int depth);

  /// From the masks alone, `masks[L - 1]` those of level L; `depth` is their number. The masks must
  /// describe a tree: is_tree(masks).
  explicit LinearOctree(std::vector<std::vector<std::uint8_t>> masks);

  /// Whether each mask holds a child, the top level is one node, and each level has as many nodes
  /// as the level above has children, fewer than 2^32.
  [[nodiscard]] static bool is_tree(std::span<const std::vector<std::uint8_t>> masks) noexcept;

  [[nodiscard]] int depth() const noexcept { return static_cast<int>(levels_.size()); }
  [[nodiscard]] std::uint32_t leaf_count() const noexcept { return leaf_count_; }
  [[nodiscard]] std::uint32_t node_count(int level) const noexcept {
    return level == 0 ? leaf_count_
                      : static_cast<std::uint32_t>(levels_[index(level)].masks.size());
  }

  /// Nodes of all levels, leaves included.
  [[nodiscard]] std::uint64_t node_count() const noexcept;

  /// Of a node at `level` >= 1: bit k says that child k is there.
  [[nodiscard]] std::uint8_t mask(int level, std::uint32_t node) const noexcept {
    return levels_[index(level)].masks[node];
  }
  /// Of a node at `level` >= 1. Child k has the index first_child + popcount(mask below k).
  [[nodiscard]] std::uint32_t first_child(int level, std::uint32_t node) const noexcept {
    return levels_[index(level)].first_child[node];
  }
  [[nodiscard]] std::span<const std::uint8_t> masks(int level) const noexcept {
    return levels_[index(level)].masks;
  }

  /// The Morton codes of the nodes at `level`, ascending. Cost: O(nodes above and at the level).
  [[nodiscard]] std::vector<std::uint64_t> codes(int level) const;

  /// Bytes in memory.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  struct Level {
    std::vector<std::uint8_t> masks;
    std::vector<std::uint32_t> first_child;
  };
  static std::size_t index(int level) noexcept { return static_cast<std::size_t>(level - 1); }

  std::uint32_t leaf_count_ = 1;
  std::vector<Level> levels_;  // level 1 first
};

}  // namespace ist
