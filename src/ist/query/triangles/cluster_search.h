#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/query/traversal/budget_meter.h"
#include "ist/query/triangles/swept_nodes.h"
#include "simd/triangles/cluster_step.h"

namespace ist {

/// A moving node above clusters, and the fixed nodes that it may be near: sixteen more may be read.
struct ClusterTask {
  std::uint32_t moving;
  int fixed_level;
  LaneNodes nodes;
};

/// A traversal of two trees of clusters, depth first: one moving node after the other, each with
/// all fixed nodes of its level that may be near it. The upper levels of the deeper tree come
/// first.
///
/// A visitor decides on the purpose:
///
///     float reach() const                 leaves out pairs that are farther apart; may shrink
///     bool visit(const ClusterPairs&)     compares the triangles; false ends the search
///     bool kMostFirst                     begin with the children that may meet most nodes
///     bool kMeasuresRest                  nearest_left() is asked for
///     bool take(const ClusterTask&)       instead of visit(), for later; false ends the search
///
/// A meter counts one test for each pair of bounds, and kClusterTests for each pair of clusters
/// whose triangles are compared.
class ClusterSearch {
 public:
  static constexpr std::uint64_t kClusterTests = 16;

  /// Reserves all memory: 80 bytes for each fixed cluster, or `items` numbers if these are more.
  /// Refers to both trees.
  ClusterSearch(const TriangleClusters& fixed, const TriangleClusters& moving,
                const ClusterKernels& kernels, std::size_t items = 0);

  /// Searches two other trees from now on, and refers to them. Allocates nothing. Precondition: the
  /// search has items_for() numbers for them.
  void bind(const TriangleClusters& fixed, const TriangleClusters& moving) noexcept;
  /// Returns the length of all lists, for a moving root of this level.
  [[nodiscard]] static std::size_t items_for(const TriangleClusters& fixed,
                                             int moving_root_level) noexcept;

  /// Sets the pose. With a sweep, the moving nodes have all bounds of a part of a motion whose
  /// middle is at the pose.
  void begin(const ClusterPose& pose, const Sweep* sweep = nullptr) noexcept;
  /// Searches from the roots. Returns false if the budget or the visitor ended the search.
  template <class Visitor>
  bool run(BudgetMeter& meter, Visitor& visitor) noexcept;

  /// Goes on with a task that another search was given at the same pose.
  template <class Visitor>
  bool run(const ClusterTask& task, BudgetMeter& meter, Visitor& visitor) noexcept {
    return descend(1, task.moving, task.fixed_level, task.nodes, meter, visitor);
  }

  /// The clusters, at the pose.
  [[nodiscard]] const ClusterStep& step() const noexcept { return step_; }
  /// Returns a lower bound of the distance of all nodes that an ended search did not come to.
  [[nodiscard]] double nearest_left() const noexcept { return nearest_left_; }
  /// Returns the bytes that a search of these trees with at least so many numbers reserves.
  [[nodiscard]] static std::size_t bytes_for(const TriangleClusters& fixed,
                                             const TriangleClusters& moving,
                                             std::size_t items = 0) noexcept {
    return std::max(items, items_for(fixed, moving.root_level())) * sizeof(std::uint32_t) +
           kMostSteps * sizeof(Step);
  }

 protected:
  // The lengths of a step's lists.
  struct Lengths {
    std::size_t bits, near, deeper;
  };
  [[nodiscard]] static Lengths step_lengths(const TriangleClusters& fixed, int moving_root_level,
                                            int level) noexcept;
  // A step from a moving node to its children, which are lanes.
  struct Step {
    TurnedBlock turned;
    std::uint32_t* bits;    // of lanes, for each fixed node that the moving one is near
    std::uint32_t* near;    // these, by lanes
    std::uint32_t* deeper;  // their children, by lanes
  };
  static constexpr std::size_t kMostSteps = TriangleClusters::kMostLevels + 2;
  // The pairs of each lane.
  struct Groups {
    std::array<LaneNodes, kClusterWidth> pairs;
    std::size_t count = 0;
  };
  // Nodes that one call of a kernel tests: some 5 µs of work, 500 tests.
  static constexpr std::size_t kPart = 31;

  // Turns the bounds of a moving node's children.
  void turn(const NodeBlock& moving, TurnedBlock& out) const noexcept {
    kernels_.turn_nodes(moving, step_.pose, out);
    if (sweep_ != nullptr) sweep_->widen(out);
  }
  [[nodiscard]] FixedNodes fixed_at(int level) const noexcept {
    return {fixed_->bounds(level).data(), fixed_->node_count(level)};
  }
  [[nodiscard]] Step& step_at(int level) noexcept {
    return steps_[static_cast<std::size_t>(level)];
  }
  template <class Visitor>
  bool descend(int moving_level, std::uint32_t moving, int fixed_level, LaneNodes nodes,
               BudgetMeter& meter, Visitor& visitor) noexcept;
  template <class Visitor>
  bool go_deeper(Step& step, int moving_level, std::uint32_t first, int fixed_level,
                 LaneNodes pairs, BudgetMeter& meter, Visitor& visitor) noexcept;
  template <class Visitor>
  bool compare(const ClusterPairs& clusters, BudgetMeter& meter, Visitor& visitor) noexcept;
  bool find_near(Step& step, std::uint32_t lanes, int fixed_level, LaneNodes nodes, float reach,
                 BudgetMeter& meter, LaneNodes& found) noexcept;
  bool find_children(Step& step, int level, LaneNodes parents, float reach, BudgetMeter& meter,
                     LaneNodes& found) const noexcept;
  static Groups by_lanes(LaneNodes pairs, bool most_first) noexcept;
  // Begins above the moving tree's root, and finds the fixed nodes of the root's level, or of the
  // fixed root's if that is lower.
  bool descend_to_root(float reach, BudgetMeter& meter, int& level, LaneNodes& nodes) noexcept;
  void note_untested(const Step& step, int fixed_level, LaneNodes pairs) noexcept;

  const TriangleClusters *fixed_ = nullptr, *moving_ = nullptr;
  const ClusterKernels& kernels_;
  std::vector<std::uint32_t> items_;  // of the lists of all steps
  std::vector<Step> steps_;           // by the moving node's level; one is above the root
  ClusterStep step_{};
  const Sweep* sweep_ = nullptr;
  bool measures_rest_ = false;
  double nearest_left_ = 0;
};

template <class Visitor>
bool ClusterSearch::run(BudgetMeter& meter, Visitor& visitor) noexcept {
  measures_rest_ = Visitor::kMeasuresRest;
  nearest_left_ = std::numeric_limits<double>::infinity();
  int level = 0;
  LaneNodes nodes{};
  if (!descend_to_root(visitor.reach(), meter, level, nodes)) return false;
  return descend(moving_->root_level(), 0, level, nodes, meter, visitor);
}

// Goes on with the children of a moving node, and with the `nodes` that they may be near.
template <class Visitor>
bool ClusterSearch::descend(int moving_level, std::uint32_t moving, int fixed_level,
                            LaneNodes nodes, BudgetMeter& meter, Visitor& visitor) noexcept {
  if (nodes.count == 0) return true;
  if constexpr (requires(ClusterTask task) { visitor.take(task); }) {
    if (moving_level == 1) return visitor.take({moving, fixed_level, nodes});
  }
  Step& step = step_at(moving_level);
  const std::uint32_t lanes = moving_->child_count(moving_level - 1, moving);
  turn(moving_->bounds(moving_level - 1)[moving], step.turned);
  LaneNodes near{};
  if (!find_near(step, lanes, fixed_level, nodes, visitor.reach(), meter, near)) return false;
  const auto go_on = [&](LaneNodes some) {
    return go_deeper(step, moving_level, kClusterWidth * moving, fixed_level, some, meter, visitor);
  };
  if (!Visitor::kMostFirst || moving_level == 1 || near.count == 0) return go_on(near);
  // The lane near most nodes goes alone, and all others follow at once. This is faster.
  const LaneNodes first = by_lanes(near, true).pairs[0];
  const auto before = static_cast<std::size_t>(first.codes - near.codes);
  const LaneNodes parts[] = {first, near.part(0, before),
                             near.part(before + first.count, near.count)};
  for (std::size_t k = 0; k < std::size(parts); ++k) {
    if (go_on(parts[k])) continue;
    while (++k < std::size(parts)) note_untested(step, fixed_level, parts[k]);
    return false;
  }
  return true;
}

// Goes on with some children of a moving node. Takes the fixed nodes one level down first, unless
// they are below the moving one.
template <class Visitor>
bool ClusterSearch::go_deeper(Step& step, int moving_level, std::uint32_t first, int fixed_level,
                              LaneNodes pairs, BudgetMeter& meter, Visitor& visitor) noexcept {
  if (moving_level <= fixed_level) {
    LaneNodes deeper{};
    --fixed_level;
    if (!find_children(step, fixed_level, pairs, visitor.reach(), meter, deeper)) {
      note_untested(step, fixed_level + 1, pairs);
      return false;
    }
    pairs = deeper;
  }
  if constexpr (requires(ClusterPairs some) { visitor.visit(some); }) {
    if (moving_level == 1) return compare({step.turned, first, pairs}, meter, visitor);
  }
  const Groups groups = by_lanes(pairs, Visitor::kMostFirst);
  for (std::size_t k = 0; k < groups.count; ++k) {
    const LaneNodes& group = groups.pairs[k];
    if (k + 1 < groups.count) {
      load_ahead(moving_->bounds(moving_level - 2)[first + groups.pairs[k + 1].lane(0)]);
    }
    if (descend(moving_level - 1, first + group.lane(0), fixed_level, group, meter, visitor)) {
      continue;
    }
    while (++k < groups.count) note_untested(step, fixed_level, groups.pairs[k]);
    return false;
  }
  return true;
}

// Compares the triangles of pairs of clusters.
template <class Visitor>
bool ClusterSearch::compare(const ClusterPairs& clusters, BudgetMeter& meter,
                            Visitor& visitor) noexcept {
  const LaneNodes& all = clusters.pairs;
  const std::size_t most = meter.is_limited() ? kPart : all.count;
  for (std::size_t k = 0; k < all.count; k += most) {
    const LaneNodes part = all.part(k, most);
    const std::uint64_t tests = kClusterTests * part.count;
    bool goes_on = meter.allows(tests);
    if (goes_on) {
      meter.spend(tests);
      goes_on = visitor.visit({clusters.lanes, clusters.moving, part});
    }
    if (!goes_on) {
      note_untested(step_at(1), 0, all.part(k, all.count));
      return false;
    }
  }
  return true;
}

}  // namespace ist
