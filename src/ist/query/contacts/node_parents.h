#pragma once

#include <cstdint>
#include <vector>

#include "ist/tree/linear_octree.h"

namespace ist {

/// The parent of each node; an octree itself stores only the children.
class NodeParents {
 public:
  /// Finds all parents. Cost: 4 bytes and 1 ns a node.
  explicit NodeParents(const LinearOctree& octree);

  /// Returns the parent, at level + 1, of a node at `level`, 0 … depth.
  [[nodiscard]] std::uint32_t of(int level, std::uint32_t node) const noexcept {
    return parents_[static_cast<std::size_t>(level)][node];
  }
  /// Returns the ancestor at `level` of a leaf.
  [[nodiscard]] std::uint32_t of_leaf(std::uint32_t leaf, int level) const noexcept {
    std::uint32_t node = leaf;
    for (int at = 0; at < level; ++at) node = of(at, node);
    return node;
  }
  [[nodiscard]] int depth() const noexcept { return static_cast<int>(parents_.size()) - 1; }
  [[nodiscard]] std::size_t leaf_count() const noexcept { return parents_[0].size(); }
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  std::vector<std::vector<std::uint32_t>> parents_;  // leaves first
};

}  // namespace ist
