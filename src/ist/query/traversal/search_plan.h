#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ist/tree/sphere_tree.h"
#include "simd/step.h"

namespace ist {

/// The levels at which a traversal ends: 0 for the leaves.
struct SearchLevels {
  int fixed = 0, moving = 0;
};

/// The steps of a breadth-first traversal, from the two roots down to the leaves, or to other
/// levels, whose nodes are called leaves here too. Holds references to both trees, which must
/// outlive it.
///
/// Each step descends the tree with the larger cubes, or both where neither cube has over √2 times
/// the other's edge. So one tree alone may descend at first, against the other's root, or at last,
/// against the other's leaves.
class SearchPlan {
 public:
  /// The most steps of a plan: a tree has at most 17 levels below its root.
  static constexpr std::size_t kMostSteps = 2 * 17;

  /// Makes the steps down to the levels `last`. Both trees must have `policy` and these levels;
  /// throws kPolicyMissing, and kMemoryLimit for a tree too large to be addressed.
  SearchPlan(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
             SearchLevels last = {});

  SearchPlan(const SearchPlan&) = delete;  // steps refer to the plan's own levels

  [[nodiscard]] const std::vector<SearchStep>& steps() const noexcept { return steps_; }

  /// Returns the most moving nodes that can be paired with one fixed node after a step.
  [[nodiscard]] std::size_t longest_row(std::size_t step) const noexcept {
    return sizes_[step].row;
  }
  /// Returns an upper bound of the pairs after a step, which counts eight children for each node: a
  /// frontier of that size is never full.
  [[nodiscard]] std::size_t most_pairs(std::size_t step) const noexcept {
    return sizes_[step].pairs;
  }

  /// Replaces addresses by indices in leaf pairs, for a tree that reached its leaves before the
  /// last step.
  void resolve(std::span<LeafPair> leaf_pairs) const noexcept;

 private:
  struct Sizes {
    std::size_t row, pairs;
  };
  std::vector<ImplicitLevel> fixed_implicit_, moving_implicit_;  // by level; empty with blocks
  std::vector<SearchStep> steps_;
  std::vector<Sizes> sizes_;
  const OctreeNode* fixed_leaves_ = nullptr;  // the parents of leaves that have addresses
  const OctreeNode* moving_leaves_ = nullptr;
};

}  // namespace ist
