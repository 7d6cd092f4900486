#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "ist/query/traversal/search_plan.h"
#include "ist/query/traversal/visitor.h"
#include "simd/lanes.h"

namespace ist {

/// The breadth-first traversal of two bounding volume hierarchies and its memory: one frontier, or
/// front, for each step. A full frontier is searched down to the leaves before it is filled again,
/// which bounds the memory and keeps the order of leaf pairs. One object belongs to one thread.
class Search {
 public:
  /// Reserves all memory: 12 bytes a step for each of `pairs`, but at least for every moving node
  /// of the level, and at most for every pair of nodes.
  Search(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs);

  /// Searches from the pair of roots down to the leaves. Returns the number of steps that are
  /// whole: all, unless the visitor ended the search early.
  template <SearchVisitor Visitor>
  std::size_t run(Visitor& visitor) noexcept {
    return descend(0, roots(), 0, visitor);
  }
  /// Searches from group `first` of `in`, the pairs before `step`; `in` may belong to another
  /// search. Returns the number of steps that are whole.
  template <SearchVisitor Visitor>
  std::size_t descend(std::size_t step, const Frontier& in, std::size_t first,
                      Visitor& visitor) noexcept {
    cursors_[step] = SearchCursor{first};
    in_row_ = false;
    return advance(step, in, visitor);
  }
  /// Searches as run() does, but may be resumed where the visitor ends it by making no test.
  /// Returns whether all steps are whole.
  template <SearchVisitor Visitor>
  bool begin(Visitor& visitor) noexcept {
    return run(visitor) == plan_.steps().size();
  }
  /// Goes on with such a search.
  template <SearchVisitor Visitor>
  bool resume(Visitor& visitor) noexcept;

  /// Returns the pairs before a step, where a visitor's enter() ended the search.
  [[nodiscard]] const Frontier& frontier(std::size_t step) const noexcept {
    return frontiers_[step];
  }

  /// Returns an upper bound of the distance: goes down both trees by the pairs that are nearest to
  /// each other or overlap most, at each step within a quarter of a fixed half edge of the least
  /// distance, until the budget is spent. Cost: some 1,000 tests a step.
  [[nodiscard]] float beam(const SearchPose& pose, BudgetMeter& meter) noexcept;

  /// Returns the bytes that a search with this memory reserves.
  [[nodiscard]] static std::size_t bytes_for(const SearchPlan& plan, std::size_t pairs) noexcept;

 private:
  struct Memory {
    std::vector<SearchGroup> groups;
    std::vector<std::uint32_t> moving;
  };
  [[nodiscard]] const Frontier& roots() noexcept;
  // Searches from a step's cursor on.
  template <SearchVisitor Visitor>
  std::size_t advance(std::size_t step, const Frontier& in, Visitor& visitor) noexcept;

  const SearchPlan& plan_;
  const Kernels& kernels_;
  std::vector<Memory> memory_;
  std::vector<Frontier> frontiers_;  // the pairs before each step, and the leaf pairs
  std::vector<SearchCursor> cursors_;
  std::size_t ended_ = 0;  // the deepest step with pairs left when a visitor ended the search
  bool in_row_ = false;    // that step ended within a row, which is not searched from until whole
  std::unique_ptr<SearchScratch> scratch_;
};

template <SearchVisitor Visitor>
bool Search::resume(Visitor& visitor) noexcept {
  const std::size_t steps = plan_.steps().size();
  for (std::size_t step = ended_ + 1; step-- > 0;) {
    if (advance(step, frontiers_[step], visitor) < steps) return false;
  }
  return true;
}

template <SearchVisitor Visitor>
std::size_t Search::advance(std::size_t step, const Frontier& in, Visitor& visitor) noexcept {
  const std::size_t steps = plan_.steps().size();
  if (step == steps) return visitor.leaves(in) ? steps : steps - 1;
  const bool last = step + 1 == steps;
  Frontier& out = frontiers_[step + 1];
  SearchCursor& cursor = cursors_[step];
  const SearchCursor first = cursor;
  while (cursor.group < in.group_count) {
    const bool begins = cursor == first;
    Frontier some = in;
    some.group_count =
        cursor.group + std::min(visitor.most_groups(), in.group_count - cursor.group);
    Frontier next = out;
    if (!std::exchange(in_row_, false)) next.group_count = next.moving_count = 0;
    if (last) next.capacity = std::min(next.capacity, visitor.most_leaves());
    Advanced made;
    do {
      made = visitor.advance({kernels_, plan_.steps()[step], some, cursor, next, *scratch_});
    } while (made.tests > 0 && !made.full && cursor.group < some.group_count);
    out.group_count = next.group_count;
    out.moving_count = next.moving_count;
    const bool ended = !made.full && cursor.group < some.group_count;
    if (ended && last) visitor.leaves(out);
    if (ended) {
      in_row_ = !last && cursor.moving > 0;
      const bool found = !last && !in_row_ && out.group_count > 0;
      if (found) cursors_[step + 1] = {};
      ended_ = found ? step + 1 : step;
      return step;
    }
    const bool rest = cursor.group < in.group_count;
    if (out.group_count == 0) continue;
    const bool whole = begins && !rest;
    if (!last && !visitor.enter(step + 1, out, whole)) return whole ? step + 1 : step;
    const std::size_t whole_steps = descend(step + 1, out, 0, visitor);
    if (whole_steps < steps) return rest ? step : whole_steps;
  }
  return steps;
}

}  // namespace ist
