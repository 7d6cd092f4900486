#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "ist/tree/sphere_tree.h"
#include "simd/step.h"

namespace ist {

/// The levels at which a traversal ends: 0 for the leaves.
struct SearchLevels {
  int fixed = 0, moving = 0;
};

/// The sizes of a tree, from which those of a search follow.
struct TreeShape {
  /// The most levels of a tree.
  static constexpr std::size_t kMostLevels = 18;
  /// Precondition: the tree has voxels.
  explicit TreeShape(const SphereTree& tree) noexcept;

  /// Makes the levels no smaller than those of another tree of the same depth and voxel size.
  void include(const TreeShape& other) noexcept;
  [[nodiscard]] bool is_like(const TreeShape& other) const noexcept {
    return depth == other.depth && voxel_size == other.voxel_size;
  }
  [[nodiscard]] double edge(int level) const noexcept {
    return voxel_size * static_cast<double>(std::uint64_t{1} << level);
  }

  double voxel_size;
  int depth;
  std::array<std::uint32_t, kMostLevels> nodes{};  ///< by level
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

  /// Throws kMemoryLimit for a tree too large to be addressed.
  static void require_addresses(const SphereTree& tree, std::string_view body);
  /// Makes the steps for two other trees, down to the leaves. Allocates nothing. Precondition: both
  /// trees fit the constructor.
  void bind(const SphereTree& fixed, const TreeShape& of_fixed, const SphereTree& moving,
            const TreeShape& of_moving, SpherePolicy policy) noexcept {
    make(fixed, of_fixed, moving, of_moving, policy, {});
  }

  /// The sizes of a step.
  struct Size {
    std::size_t row;    ///< the most moving nodes that can be paired with one fixed node after it
    std::size_t pairs;  ///< an upper bound of the pairs after it
  };
  struct Sizes {
    std::array<Size, kMostSteps> steps;
    std::size_t count = 0;
  };
  /// Returns the sizes of the steps down to the leaves of two trees of such shapes.
  [[nodiscard]] static Sizes sizes_of(const TreeShape& fixed, const TreeShape& moving) noexcept;

  [[nodiscard]] const std::vector<SearchStep>& steps() const noexcept { return steps_; }

  /// Returns the most moving nodes that can be paired with one fixed node after a step.
  [[nodiscard]] std::size_t longest_row(std::size_t step) const noexcept {
    return sizes_.steps[step].row;
  }
  /// Returns an upper bound of the pairs after a step, which counts eight children for each node: a
  /// frontier of that size is never full.
  [[nodiscard]] std::size_t most_pairs(std::size_t step) const noexcept {
    return sizes_.steps[step].pairs;
  }
  [[nodiscard]] const Sizes& sizes() const noexcept { return sizes_; }

  /// Replaces addresses by indices in leaf pairs, for a tree that reached its leaves before the
  /// last step.
  void resolve(std::span<LeafPair> leaf_pairs) const noexcept;

 private:
  void make(const SphereTree& fixed, const TreeShape& of_fixed, const SphereTree& moving,
            const TreeShape& of_moving, SpherePolicy policy, SearchLevels last) noexcept;

  std::vector<ImplicitLevel> fixed_implicit_, moving_implicit_;  // by level; empty with blocks
  std::vector<SearchStep> steps_;
  Sizes sizes_;
  const OctreeNode* fixed_leaves_ = nullptr;  // the parents of leaves that have addresses
  const OctreeNode* moving_leaves_ = nullptr;
};

}  // namespace ist
