#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "ist/query/dive.h"
#include "ist/query/traversal/leaf_pair_sink.h"
#include "ist/query/traversal/search_plan.h"
#include "ist/query/traversal/spending.h"
#include "simd/dispatch.h"
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

  /// Searches from the pair of roots down to the leaves, or until the sink stops. Returns the
  /// number of pairs tested.
  std::uint64_t run(const SearchPose& pose, LeafPairSink& sink) noexcept;
  /// Searches like run(), in batches of `groups` fixed nodes a level: the first leaf pairs come
  /// sooner, all of them later. The sink may change `pose` while it takes leaf pairs; smaller pads
  /// then leave out farther pairs from there on.
  std::uint64_t run_hurried(const SearchPose& pose, LeafPairSink& sink,
                            std::size_t groups) noexcept;

  /// The result of run_until().
  struct Stopped {
    std::uint64_t tests;
    std::size_t steps;         ///< completed steps; fewer than all if the budget ended the search
    std::uint64_t leaf_pairs;  ///< given to the sink
  };
  /// Searches like run(), until the budget is spent or exceeded by a little: it looks between parts
  /// of some 1,000 tests or 512 leaf pairs. A deadline stops at a repeatable point: running again
  /// with `tests` set to the reported count stops at the same place.
  [[nodiscard]] Stopped run_until(const Budget& budget, const SearchPose& pose,
                                  LeafPairSink& sink) noexcept;
  /// Continues run_until() from group `first` of `in`, the pairs before `step`, after `tests`
  /// tests.
  [[nodiscard]] Stopped descend_until(const Budget& budget, std::uint64_t tests, std::size_t step,
                                      const Frontier& in, std::size_t first, const SearchPose& pose,
                                      LeafPairSink& sink) noexcept;

  /// Searches level by level from the roots, until there are at least `pairs` pairs, no pair, or
  /// leaf pairs, or the next frontier is full. Returns the number of steps made and adds to
  /// `tests`.
  std::size_t widen(const SearchPose& pose, std::size_t pairs, std::uint64_t& tests) noexcept;
  /// Returns the pairs before a step, as widen() left them.
  [[nodiscard]] const Frontier& frontier(std::size_t step) const noexcept {
    return frontiers_[step];
  }

  /// Searches down to the leaves from group `first` of `in`, the pairs before `step`; `in` may
  /// belong to another search. Returns the number of pairs tested.
  std::uint64_t descend(std::size_t step, const Frontier& in, std::size_t first,
                        const SearchPose& pose, LeafPairSink& sink) noexcept;

  /// The certified result of run_within() at any budget.
  struct AnytimeResult {
    std::uint64_t tests = 0;
    DistanceBounds inner, leaves;  ///< bounds of all steps but the last, and of the last
    std::size_t steps = 0;         ///< completed
  };
  /// The most leaf pairs that the sink takes at once within a budget: some µs between two looks at
  /// the clock.
  static constexpr std::size_t kLeavesAtOnce = 1 << 12;
  /// Searches like run() within a budget, level by level from the roots, or chunk by chunk where a
  /// frontier is full, and bounds the distance by every pair that it tests. If the budget ends the
  /// search early, the sink has the first leaf pairs.
  [[nodiscard]] AnytimeResult run_within(const Budget& budget, const SearchPose& pose,
                                         LeafPairSink& sink) noexcept;

  /// Finds leaf pairs near each other by a beam search.
  [[nodiscard]] Dive dive(const SearchPose& pose) noexcept {
    return ist::dive(plan_, kernels_, pose, *scratch_);
  }

  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  struct Memory {
    std::vector<SearchGroup> groups;
    std::vector<std::uint32_t> moving;
  };
  // The budget of run_until().
  struct Stopping {
    Budget budget;
    std::uint64_t tests = 0;
    std::size_t steps = std::numeric_limits<std::size_t>::max();  // completed

    // Returns whether to stop at a step that is not complete.
    [[nodiscard]] bool now(std::size_t step) noexcept {
      const bool over = tests >= budget.tests || budget.is_past();
      if (over) steps = std::min(steps, step);
      return over;
    }
  };
  void set_roots() noexcept;
  [[nodiscard]] bool descend_within(std::size_t step, const SearchPose& pose, LeafPairSink& sink,
                                    Spending& spending, AnytimeResult& known) noexcept;
  [[nodiscard]] bool advance_within(std::size_t step, const SearchPose& pose, SearchCursor& cursor,
                                    Spending& spending, DistanceBounds& measure) noexcept;

  const SearchPlan& plan_;
  const Kernels& kernels_;
  std::vector<Memory> memory_;
  std::vector<Frontier> frontiers_;  // the pairs before each step, and the leaf pairs
  std::unique_ptr<SearchScratch> scratch_;
  static constexpr std::size_t kAllGroups = std::numeric_limits<std::size_t>::max();
  std::size_t groups_at_once_ = kAllGroups;
  Stopping stopping_;
};

}  // namespace ist
