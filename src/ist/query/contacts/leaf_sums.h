#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/contacts/contact_pair.h"
#include "ist/query/contacts/node_parents.h"

namespace ist {

/// The sums over all leaf pairs of one moving node, in the fixed tree's frame. Two of them add up
/// to that of a common ancestor.
struct LeafSum {
  std::uint32_t node;
  double weight, depth;              ///< Σ w and Σ w d
  Eigen::Vector3d position, normal;  ///< Σ w p and Σ w n
  double deepest;                    ///< the greatest depth of a pair
  Eigen::Vector3d deepest_normal;    ///< that pair's normal, for a sum that has no direction

  LeafSum(std::uint32_t of, const PairTerms& pair) noexcept
      : node(of),
        weight(pair.weight),
        depth(pair.weight * pair.depth),
        position(scaled(pair.weight, pair.position)),
        normal(scaled(pair.weight, pair.normal)),
        deepest(pair.depth),
        deepest_normal(pair.normal) {}
  LeafSum() = default;

  void add(const PairTerms& pair) noexcept { add(LeafSum(node, pair)); }
  void add(const LeafSum& other) noexcept {
    weight += other.weight;
    depth += other.depth;
    add_to(position, other.position);
    add_to(normal, other.normal);
    if (other.deepest <= deepest) return;
    deepest = other.deepest;
    deepest_normal = other.deepest_normal;
  }
};

/// Adds up leaf pairs by their moving leaf, in bounded memory. When there are more leaves than fit,
/// all sums are merged by their parents, and later pairs are added at that level. Nothing is
/// dropped. The nodes and their order follow from the order of the pairs alone.
class LeafSums {
 public:
  /// Reserves 4 bytes a moving leaf, and 104 for each of `most` nodes. With `most` = 0 nothing may
  /// be added.
  LeafSums(const NodeParents& parents, std::size_t most);

  void clear() noexcept;
  /// Adds a leaf pair. Cost: 5 ns.
  void add(std::uint32_t leaf, const PairTerms& pair) noexcept {
    LeafSum* found = find(parents_.of_leaf(leaf, level_));
    if (found != nullptr) {
      found->add(pair);
    } else {
      insert(leaf, pair);
    }
  }

  /// Returns the nodes, in the order in which they were first added.
  [[nodiscard]] std::span<LeafSum> nodes() noexcept { return {nodes_.data(), count_}; }
  /// Returns the level of the nodes: 0 as long as they are leaves.
  [[nodiscard]] int level() const noexcept { return level_; }

  /// Merges the nodes by their parents, one level up. Precondition: level() < depth of the tree.
  void coarsen() noexcept;
  /// Removes the nodes at a few places.
  void take_out(std::span<const std::size_t> places) noexcept;

  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  void insert(std::uint32_t leaf, const PairTerms& pair) noexcept;
  // Returns null where the node has no sum.
  [[nodiscard]] LeafSum* find(std::uint32_t node) noexcept {
    const std::uint32_t place = place_[node];
    return place < count_ && nodes_[place].node == node ? &nodes_[place] : nullptr;
  }

  const NodeParents& parents_;
  std::vector<std::uint32_t> place_;  // by node of the level; valid where nodes_ agrees
  std::vector<LeafSum> nodes_;
  std::size_t count_ = 0;
  int level_ = 0;
};

}  // namespace ist
