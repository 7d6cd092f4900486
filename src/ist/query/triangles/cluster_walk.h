#pragma once

#include <array>
#include <cstdint>

#include "ist/query/triangles/cluster_search.h"

namespace ist {

/// A ClusterSearch in slices: it stops after some tests, and goes on from there in a later call at
/// the same pose. The reach stays the same, so that no visitor is asked for it.
class ClusterWalk : private ClusterSearch {
 public:
  using ClusterSearch::bytes_for, ClusterSearch::ClusterSearch, ClusterSearch::step;

  /// Begins at the roots.
  void begin(const ClusterPose& pose, float reach) noexcept {
    ClusterSearch::begin(pose);
    reach_ = reach;
    BudgetMeter meter;
    int fixed_level = 0;
    LaneNodes nodes{};
    descend_to_root(reach_, meter, fixed_level, nodes);
    root_ = static_cast<std::size_t>(moving_.root_level());
    level_ = root_;
    left_ = {};
    enter(level_, 0, fixed_level, nodes, meter);
    tests_ = meter.spent();
  }
  /// Whether all was visited.
  [[nodiscard]] bool is_whole() const noexcept { return level_ > root_; }
  /// Returns the tests since begin(), as ClusterSearch counts them.
  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }

  /// Goes on by one step, some hundred tests. Calls `visit(const ClusterPairs&)` if pairs of
  /// clusters may be within reach. Returns false if `visit` does.
  template <class Visit>
  bool advance(Visit visit) noexcept {
    Left& left = left_[level_];
    if (left.done == (level_ == 1 ? left.pairs.count : left.groups.count)) {
      ++level_;
      return true;
    }
    if (level_ > 1) {
      next_group(left);
      return true;
    }
    const LaneNodes part = left.pairs.part(left.done, kPart);
    left.done += part.count;
    tests_ += kClusterTests * part.count;
    return visit(ClusterPairs{step_at(1).turned, left.first, part});
  }

 private:
  // The nodes of a level that are left: groups of lanes, or pairs of clusters on level 1.
  struct Left {
    Groups groups;
    LaneNodes pairs{};
    std::uint32_t first = 0;  // the child that is lane 0
    int fixed_level = 0;
    std::size_t done = 0;
  };

  // Finds the children of a moving node that may be near some fixed nodes.
  void enter(std::size_t level, std::uint32_t moving, int fixed_level, LaneNodes nodes,
             BudgetMeter& meter) noexcept {
    const int moving_level = static_cast<int>(level);
    Step& step = step_at(moving_level);
    Left& left = left_[level];
    left.first = kClusterWidth * moving;
    left.fixed_level = fixed_level;
    left.pairs = {};
    left.groups.count = left.done = 0;
    if (nodes.count == 0) return;
    const std::uint32_t lanes = moving_.child_count(moving_level - 1, moving);
    kernels_.turn_nodes(moving_.bounds(moving_level - 1)[moving], step_.pose, step.turned);
    find_near(step, lanes, fixed_level, nodes, reach_, meter, left.pairs);
    if (moving_level <= fixed_level) {
      LaneNodes deeper{};
      find_children(step, --left.fixed_level, left.pairs, reach_, meter, deeper);
      left.pairs = deeper;
    }
    if (level > 1) left.groups = by_lanes(left.pairs, false);
  }
  void next_group(Left& left) noexcept {
    const LaneNodes group = left.groups.pairs[left.done++];
    BudgetMeter meter;
    --level_;
    enter(level_, left.first + group.lane(0), left.fixed_level, group, meter);
    tests_ += meter.spent();
  }
  float reach_ = 0;
  std::size_t root_ = 0, level_ = 1;
  std::uint64_t tests_ = 0;
  std::array<Left, TriangleClusters::kMostLevels + 2> left_{};
};

}  // namespace ist
