#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/contacts/contact_pair.h"
#include "ist/query/contacts/node_parents.h"

namespace ist {

/// What all leaf pairs of one moving node come to, in the fixed tree's frame: sums, so that two of
/// them are added to one.
struct TouchedNode {
  std::uint32_t node;
  double weight, depth;              ///< of w, and of w d
  Eigen::Vector3d position, normal;  ///< of w p, and of w n
  double deepest;                    ///< depth of a pair
  Eigen::Vector3d deepest_normal;    ///< of that pair: the direction where the sum has none

  TouchedNode(std::uint32_t of, const PairTerms& pair) noexcept
      : node(of),
        weight(pair.weight),
        depth(pair.weight * pair.depth),
        position(scaled(pair.weight, pair.position)),
        normal(scaled(pair.weight, pair.normal)),
        deepest(pair.depth),
        deepest_normal(pair.normal) {}
  TouchedNode() = default;

  void add(const PairTerms& pair) noexcept { add(TouchedNode(node, pair)); }
  void add(const TouchedNode& other) noexcept {
    weight += other.weight;
    depth += other.depth;
    add_to(position, other.position);
    add_to(normal, other.normal);
    if (other.deepest <= deepest) return;
    deepest = other.deepest;
    deepest_normal = other.deepest_normal;
  }
};

/// Adds up leaf pairs by their moving leaf, in bounded memory: where there are more touched leaves
/// than there is room for, all that are known are added up by their parents, and so is what comes.
/// Nothing is dropped. Which nodes are in it, and in which order, follows from the order of pairs.
class TouchedLeaves {
 public:
  /// Memory: 4 bytes a moving leaf, and 104 for each of `most` nodes. With none nothing is added.
  TouchedLeaves(const NodeParents& parents, std::size_t most);

  void clear() noexcept;
  /// Cost: 5 ns.
  void add(std::uint32_t leaf, const PairTerms& pair) noexcept {
    TouchedNode* found = find(parents_.of_leaf(leaf, level_));
    if (found != nullptr) {
      found->add(pair);
    } else {
      insert(leaf, pair);
    }
  }

  /// In the order in which they were first touched.
  [[nodiscard]] std::span<TouchedNode> nodes() noexcept { return {nodes_.data(), count_}; }
  /// Of the nodes: 0 as long as they are leaves.
  [[nodiscard]] int level() const noexcept { return level_; }

  /// Adds the nodes up by their parents, one level up. Precondition: level() < depth of the tree.
  void coarsen() noexcept;
  /// Takes out the nodes with these places, a few.
  void take_out(std::span<const std::size_t> places) noexcept;

  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  void insert(std::uint32_t leaf, const PairTerms& pair) noexcept;
  // Null where it is not there.
  [[nodiscard]] TouchedNode* find(std::uint32_t node) noexcept {
    const std::uint32_t place = place_[node];
    return place < count_ && nodes_[place].node == node ? &nodes_[place] : nullptr;
  }

  const NodeParents& parents_;
  std::vector<std::uint32_t> place_;  // by node of the level; true only where that node is there
  std::vector<TouchedNode> nodes_;
  std::size_t count_ = 0;
  int level_ = 0;
};

}  // namespace ist
