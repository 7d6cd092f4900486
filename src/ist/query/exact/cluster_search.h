#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "ist/query/exact/cluster_budget.h"
#include "ist/query/relative_pose.h"
#include "ist/tree/clusters/triangle_clusters.h"
#include "simd/exact/cluster_step.h"

namespace ist {

/// A moving cluster, and fixed nodes whose clusters may be near it.
struct ClusterTask {
  const TurnedBlock& lanes;
  std::uint32_t lane, moving;
  NodeList parents;
};

/// The outcome of a task: whether the search goes on, and the pairs of clusters compared.
struct Visited {
  bool goes_on;
  std::size_t cluster_pairs;
};

/// A traversal of two trees of clusters, depth first: one moving node after the other, each with
/// all fixed nodes of its level that may be near it. Where the fixed tree is deeper, its upper
/// levels come first; where the moving tree is, its own.
///
/// A visitor says what is looked for:
///
///     float reach() const                 what is farther apart is not looked for; may shrink
///     Visited visit(const ClusterTask&)   compares the triangles
///     bool kMostFirst                     begin with the children that may meet most nodes
///     bool kMeasuresRest                  nearest_left() is asked for
class ClusterSearch {
 public:
  /// Reserves all memory: 10 to 14 bytes for each fixed cluster. Holds references to both trees.
  ClusterSearch(const TriangleClusters& fixed, const TriangleClusters& moving,
                const ClusterKernels& kernels);

  /// Searches from the roots. Returns false where the budget or the visitor ended the search.
  template <class Visitor>
  bool run(const ClusterPose& pose, ClusterBudget& budget, Visitor& visitor) noexcept;

  /// The clusters, at the pose of the last run.
  [[nodiscard]] const ClusterStep& step() const noexcept { return step_; }
  /// Returns a lower bound of the distance of all nodes that an ended search did not come to.
  [[nodiscard]] double nearest_left() const noexcept { return nearest_left_; }
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  // A step from a moving node to its children.
  struct Step {
    TurnedBlock turned;                // the children
    LaneLists lists;                   // of fixed nodes near each child
    std::vector<std::uint32_t> near;   // what is in the lists
    std::vector<std::uint32_t> nodes;  // the children, near one child, of those in its list
  };
  using Order = std::array<std::uint8_t, kClusterWidth>;
  // Nodes that one call of a kernel tests: some 10 µs of work, 500 tests.
  static constexpr std::size_t kPart = 31;

  void begin(const ClusterPose& pose, bool measures_rest) noexcept;
  [[nodiscard]] FixedNodes fixed_at(int level) const noexcept {
    return {fixed_.bounds(level).data(), fixed_.node_count(level)};
  }
  [[nodiscard]] Step& step_at(int level) noexcept {
    return steps_[static_cast<std::size_t>(level)];
  }
  template <class Visitor>
  bool descend(int moving_level, std::uint32_t moving, int fixed_level, NodeList nodes,
               ClusterBudget& budget, Visitor& visitor) noexcept;
  template <class Visitor>
  bool go_on(Step& step, std::uint32_t lane, int moving_level, std::uint32_t child, int fixed_level,
             NodeList parents, ClusterBudget& budget, Visitor& visitor) noexcept;
  bool find_lists(Step& step, std::uint32_t lanes, int fixed_level, NodeList nodes, float reach,
                  ClusterBudget& budget) const noexcept;
  bool find_children(Step& step, std::uint32_t lane, int level, NodeList parents, float reach,
                     ClusterBudget& budget, NodeList& found) const noexcept;
  static Order most_first(const LaneLists& lists) noexcept;
  void leave(const Step& step, std::uint32_t lane, int fixed_level, NodeList nodes) noexcept;

  const TriangleClusters &fixed_, &moving_;
  const ClusterKernels& kernels_;
  std::vector<Step> steps_;  // by the moving node's level; the last one is above the root
  ClusterStep step_{};
  bool measures_rest_ = false;
  double nearest_left_ = 0;
};

template <class Visitor>
bool ClusterSearch::run(const ClusterPose& pose, ClusterBudget& budget, Visitor& visitor) noexcept {
  begin(pose, Visitor::kMeasuresRest);
  // Above its root the moving tree has a node of one child.
  Step& top = steps_.back();
  kernels_.turn_nodes(moving_.bounds(moving_.root_level())[0], pose, top.turned);
  int level = fixed_.root_level();
  constexpr std::uint32_t kRoot = 0;
  NodeList nodes{&kRoot, 1};
  while (level > moving_.root_level()) {
    std::copy_n(nodes.nodes, nodes.count, top.near.begin());
    const NodeList parents{top.near.data(), nodes.count};
    --level;
    if (!find_children(top, 0, level, parents, visitor.reach(), budget, nodes)) {
      leave(top, 0, level + 1, parents);
      return false;
    }
  }
  return descend(moving_.root_level(), 0, level, nodes, budget, visitor);
}

// Goes on with the children of a moving node, each with those of `nodes` that it may be near.
template <class Visitor>
bool ClusterSearch::descend(int moving_level, std::uint32_t moving, int fixed_level, NodeList nodes,
                            ClusterBudget& budget, Visitor& visitor) noexcept {
  if (nodes.count == 0) return true;
  Step& step = step_at(moving_level);
  const std::uint32_t lanes = moving_.child_count(moving_level - 1, moving);
  kernels_.turn_nodes(moving_.bounds(moving_level - 1)[moving], step_.pose, step.turned);
  if (!find_lists(step, lanes, fixed_level, nodes, visitor.reach(), budget)) {
    for (std::uint32_t lane = 0; lane < lanes; ++lane) leave(step, lane, fixed_level, nodes);
    return false;
  }
  Order order{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  if constexpr (Visitor::kMostFirst) order = most_first(step.lists);
  for (std::uint32_t k = 0; k < kClusterWidth; ++k) {
    const std::uint32_t lane = order[k];
    const NodeList parents = step.lists[lane];
    if (parents.count == 0 || go_on(step, lane, moving_level, kClusterWidth * moving + lane,
                                    fixed_level, parents, budget, visitor)) {
      continue;
    }
    while (++k < kClusterWidth) leave(step, order[k], fixed_level, step.lists[order[k]]);
    return false;
  }
  return true;
}

// Goes on with one child, and the nodes that it may be near.
template <class Visitor>
bool ClusterSearch::go_on(Step& step, std::uint32_t lane, int moving_level, std::uint32_t child,
                          int fixed_level, NodeList parents, ClusterBudget& budget,
                          Visitor& visitor) noexcept {
  if (moving_level > fixed_level) {
    return descend(moving_level - 1, child, fixed_level, parents, budget, visitor);
  }
  if (moving_level > 1) {
    NodeList nodes{};
    if (!find_children(step, lane, fixed_level - 1, parents, visitor.reach(), budget, nodes)) {
      leave(step, lane, fixed_level, parents);
      return false;
    }
    return descend(moving_level - 1, child, fixed_level - 1, nodes, budget, visitor);
  }
  const std::size_t part = budget.is_limited() ? 1 : parents.count;
  constexpr std::uint64_t kMost = kClusterWidth * (1 + ClusterBudget::kClusterTests);
  for (std::size_t k = 0; k < parents.count; k += part) {
    const NodeList list{parents.nodes + k, part};
    Visited visited{false, 0};
    if (budget.allows(kMost)) {
      visited = visitor.visit({step.turned, lane, child, list});
      budget.spend(fixed_at(0).children_of(list) +
                   ClusterBudget::kClusterTests * visited.cluster_pairs);
    }
    if (!visited.goes_on) {
      leave(step, lane, fixed_level, {list.nodes, parents.count - k});
      return false;
    }
  }
  return true;
}

}  // namespace ist
