#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "ist/query/traversal/search_plan.h"
#include "ist/query/traversal/visitor.h"
#include "simd/lanes.h"

namespace ist {

/// A place in a search: the next pair to be tested in each step that has begun. It refers to the
/// pairs that its Search keeps, so it is valid until that Search makes another search.
struct SearchPosition {
  /// Makes the position of group `first` of `in`, the pairs before step `top`.
  SearchPosition(std::size_t top, const Frontier& in, std::size_t first) noexcept
      : pairs(in), first_group(first), first_step(top), step(top) {
    cursors[top] = {first};
  }

  /// Returns whether all pairs have been searched down to the leaves.
  [[nodiscard]] bool is_end() const noexcept {
    return step == first_step && cursors[step].group == pairs.group_count;
  }

  Frontier pairs;           ///< before the first step
  std::size_t first_group;  ///< of these
  std::size_t first_step;
  std::size_t step;  ///< the deepest step that has begun: the search goes on with it
  /// By step, from the first one to the deepest one. Only a cursor inside a row of an inner step
  /// has `moving` > 0. Then the pairs behind the step end with the tested part of that row, and
  /// are not searched before the row is whole.
  std::array<SearchCursor, SearchPlan::kMostSteps> cursors{};
};

/// The breadth-first traversal of two bounding volume hierarchies and its memory: one frontier
/// for each step. A full frontier is searched down to the leaves before it is filled again. This
/// bounds the memory and keeps the order of leaf pairs. One object belongs to one thread.
class Search {
 public:
  /// Reserves all memory: 12 bytes a step for each of `pairs`, but at least for every moving node
  /// of the level, and at most for every pair of nodes; `items` of 12 bytes if these are more.
  Search(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs, std::size_t items = 0);

  /// Call after the plan was made anew, for other trees. Allocates nothing. Precondition: the
  /// search has items_for() the plan.
  void bind() noexcept;
  /// Returns the length of all frontiers.
  [[nodiscard]] static std::size_t items_for(const SearchPlan::Sizes& sizes,
                                             std::size_t pairs) noexcept;

  /// Searches from the pair of roots down to the leaves. Returns the number of steps that are
  /// whole: all, unless the visitor ended the search early.
  template <SearchVisitor Visitor>
  std::size_t run(Visitor& visitor) noexcept {
    SearchPosition at = roots();
    return advance(at, visitor);
  }
  /// Searches from group `first` of `in`, the pairs before `step`. `in` may belong to another
  /// search. Returns the number of steps that are whole.
  template <SearchVisitor Visitor>
  std::size_t descend(std::size_t step, const Frontier& in, std::size_t first,
                      Visitor& visitor) noexcept {
    SearchPosition at(step, in, first);
    return advance(at, visitor);
  }

  /// Returns the position at which a search begins: the pair of roots.
  [[nodiscard]] SearchPosition roots() const noexcept { return {0, frontiers_.front(), 0}; }
  /// Searches from roots(), or goes on from the position that the last call returned. Returns the
  /// position at which the visitor ended the search by making no test, or the end.
  template <SearchVisitor Visitor>
  [[nodiscard]] SearchPosition resume(SearchPosition at, Visitor& visitor) noexcept {
    advance(at, visitor);
    return at;
  }

  /// Returns the pairs before a step. Use it after a visitor's enter() ended the search.
  [[nodiscard]] const Frontier& frontier(std::size_t step) const noexcept {
    return frontiers_[step];
  }

  /// Returns an upper bound of the distance: goes down both trees by the pairs that are nearest to
  /// each other or overlap most, at each step within a quarter of a fixed half edge of the least
  /// distance, until the budget is spent. Cost: some 1,000 tests a step.
  [[nodiscard]] float beam(const SearchPose& pose, BudgetMeter& meter) noexcept;

  /// Returns the bytes that a search with this memory reserves.
  [[nodiscard]] static std::size_t bytes_for(const SearchPlan& plan, std::size_t pairs,
                                             std::size_t items = 0) noexcept;

 private:
  // Searches from a position on, and moves it. Returns the number of steps that are whole.
  template <SearchVisitor Visitor>
  std::size_t advance(SearchPosition& at, Visitor& visitor) noexcept;
  // Fills the frontier behind a step: tests the pairs `in` from `cursor` on. Returns true if all
  // were tested or the frontier is full, and false if the visitor ended the search before.
  template <SearchVisitor Visitor>
  bool fill(std::size_t step, const Frontier& in, SearchCursor& cursor, Visitor& visitor) noexcept;
  [[nodiscard]] const Frontier& pairs_before(std::size_t step,
                                             const SearchPosition& at) const noexcept {
    return step == at.first_step ? at.pairs : frontiers_[step];
  }
  // Returns the first step that has pairs left at a position, or `most`.
  [[nodiscard]] std::size_t whole_steps(const SearchPosition& at, std::size_t most) const noexcept;

  const SearchPlan& plan_;
  const Kernels& kernels_;
  std::size_t most_pairs_;
  std::vector<SearchGroup> groups_;    // of all frontiers
  std::vector<std::uint32_t> moving_;  // as well
  std::vector<Frontier> frontiers_;    // the pairs before each step, and the leaf pairs
  std::unique_ptr<SearchScratch> scratch_;
};

template <SearchVisitor Visitor>
std::size_t Search::advance(SearchPosition& at, Visitor& visitor) noexcept {
  const std::size_t steps = plan_.steps().size();
  while (true) {
    const std::size_t step = at.step;
    const Frontier& in = pairs_before(step, at);
    SearchCursor& cursor = at.cursors[step];
    if (cursor.group == in.group_count) {
      if (step == at.first_step) return steps;
      --at.step;
      continue;
    }
    // A visitor enters a frontier as a whole one if a single filling holds all pairs of the step.
    const bool begins = cursor == SearchCursor{step == at.first_step ? at.first_group : 0};
    const bool enough = fill(step, in, cursor, visitor);
    const Frontier& out = frontiers_[step + 1];
    if (step + 1 == steps) {
      const bool wanted = out.group_count == 0 || visitor.leaves(out);
      if (!wanted || !enough) return whole_steps(at, step);
      continue;
    }
    // The pairs that were found are searched before the rest, but for a row that is not whole yet.
    const bool descends = out.group_count > 0 && cursor.moving == 0;
    if (descends && enough) {
      const bool whole = begins && cursor.group == in.group_count;
      if (!visitor.enter(step + 1, out, whole)) return whole_steps(at, whole ? step + 1 : step);
    }
    if (descends) at.cursors[at.step = step + 1] = {};
    if (!enough) return whole_steps(at, step);
  }
}

template <SearchVisitor Visitor>
bool Search::fill(std::size_t step, const Frontier& in, SearchCursor& cursor,
                  Visitor& visitor) noexcept {
  const bool last = step + 1 == plan_.steps().size();
  Frontier some = in;
  some.group_count = cursor.group + std::min(visitor.most_groups(), in.group_count - cursor.group);
  Frontier& out = frontiers_[step + 1];
  Frontier next = out;
  if (last || cursor.moving == 0) next.group_count = next.moving_count = 0;
  if (last) next.capacity = std::min(next.capacity, visitor.most_leaves());
  Advanced made;
  do {
    made = visitor.advance({kernels_, plan_.steps()[step], some, cursor, next, *scratch_});
  } while (made.tests > 0 && !made.full && cursor.group < some.group_count);
  out.group_count = next.group_count;
  out.moving_count = next.moving_count;
  return made.full || cursor.group == some.group_count;
}

}  // namespace ist
