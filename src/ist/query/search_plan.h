#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/search_step.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// The levels at which a search ends: 0 for the leaves.
struct SearchLevels {
  int fixed = 0, moving = 0;
};

/// The steps of a search, from the two roots down to the leaves, or to the nodes of other levels,
/// which are called leaves here too. Holds references to both trees, which must outlive it.
///
/// Of two levels the one with the larger cubes is opened, and both where neither cube has over √2
/// times the other's edge. So one tree may be opened alone at first, with the other's root, and one
/// at last, with the other's leaves; in between both always are.
class SearchPlan {
 public:
  /// Both trees must have `policy` (SphereTree::require), and the levels.
  SearchPlan(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
             SearchLevels last = {});

  [[nodiscard]] const std::vector<SearchStep>& steps() const noexcept { return steps_; }

  /// The most moving nodes that one fixed node can meet after a step.
  [[nodiscard]] std::size_t longest_row(std::size_t step) const noexcept {
    return sizes_[step].row;
  }
  /// The most pairs that there can be after it, if every node that is opened had eight children: so
  /// much room is never found to be too little.
  [[nodiscard]] std::size_t most_pairs(std::size_t step) const noexcept {
    return sizes_[step].pairs;
  }

  /// The leaves' indices, where contacts name them by address because that tree ended first.
  void resolve(std::span<Contact> contacts) const noexcept;

 private:
  struct Sizes {
    std::size_t row, pairs;
  };
  std::vector<SearchStep> steps_;
  std::vector<Sizes> sizes_;
  const OctreeNode* fixed_leaves_ = nullptr;  // the leaves' parents, where named by address
  const OctreeNode* moving_leaves_ = nullptr;
};

}  // namespace ist
