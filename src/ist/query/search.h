#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "ist/query/bound_lanes.h"
#include "ist/query/budget.h"
#include "ist/query/contact_sink.h"
#include "ist/query/dive.h"
#include "ist/query/search_plan.h"

namespace ist {

/// The memory of a search and the way through it: breadth first, one frontier a step. A frontier
/// that is full is searched down to the leaves before it is filled again, so that memory is bounded
/// and the order of contacts stays. One belongs to one thread.
class Search {
 public:
  /// Reserves all memory: per step 12 bytes for each of `pairs`, or for each moving node at its
  /// level, where there are more of those, or for every pair of nodes, where there are fewer.
  Search(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs);

  /// Searches from the pair of the roots down to the leaves, or until the sink is stopped. Returns
  /// the number of pairs tested.
  std::uint64_t run(const SearchPose& pose, ContactSink& sink) noexcept;
  /// The same, with so many fixed nodes at a time at each level: comes to its first leaves sooner,
  /// and to all of them later. `pose` may change while the sink takes contacts, and is read anew
  /// then: with smaller pads what is farther is left out from there on.
  std::uint64_t run_hurried(const SearchPose& pose, ContactSink& sink, std::size_t groups) noexcept;

  /// What a search that may end early came to.
  struct Stopped {
    std::uint64_t tests;
    std::size_t steps;       ///< that were made whole: all of them, or the budget ended it
    std::uint64_t contacts;  ///< that the sink was given
  };
  /// As run(), until so many tests are made or the deadline is past, or a little more: it looks
  /// between parts of some 1,000 tests or 512 contacts, which are the same every time. So where it
  /// was stopped by the clock after some tests, a budget of as many stops it there again.
  [[nodiscard]] Stopped run_until(const Budget& budget, const SearchPose& pose,
                                  ContactSink& sink) noexcept;
  /// The rest of it, from group `first` of the pairs before `step` on, after so many tests.
  [[nodiscard]] Stopped descend_until(const Budget& budget, std::uint64_t tests, std::size_t step,
                                      const Frontier& in, std::size_t first, const SearchPose& pose,
                                      ContactSink& sink) noexcept;

  /// Searches level by level from the roots, until there are at least `pairs` pairs, none, or
  /// those of the leaves, or more than there is room for. Returns how many steps were made;
  /// `tests` is added to.
  std::size_t widen(const SearchPose& pose, std::size_t pairs, std::uint64_t& tests) noexcept;
  /// The pairs before a step, as widen() left them.
  [[nodiscard]] const Frontier& frontier(std::size_t step) const noexcept {
    return frontiers_[step];
  }

  /// Searches from the pairs before `step` down to the leaves: from group `first` of `in` on, which
  /// may be memory of another. Returns the number of pairs tested.
  std::uint64_t descend(std::size_t step, const Frontier& in, std::size_t first,
                        const SearchPose& pose, ContactSink& sink) noexcept;

  /// What a search within a budget found out.
  struct Known {
    std::uint64_t tests = 0;
    Measure inner, leaves;  ///< of all steps but the last, and of that
    std::size_t steps = 0;  ///< that were made whole
  };
  /// Within a budget the sink takes so many contacts at a time: some µs in which nobody
  /// looks at the clock.
  static constexpr std::size_t kLeavesAtOnce = 1 << 12;
  /// As run(), step by step from the roots on, or where a frontier is full from chunk to chunk, as
  /// long as there is something left to spend; and measures all pairs that are tested. Where it
  /// ends early the sink has the first contacts.
  [[nodiscard]] Known run_within(const Budget& budget, const SearchPose& pose,
                                 ContactSink& sink) noexcept;

  /// Pairs of leaves that are near each other.
  [[nodiscard]] Dive dive(const SearchPose& pose) noexcept {
    return ist::dive(plan_, kernels_, pose, *scratch_);
  }

  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  struct Memory {
    std::vector<SearchGroup> groups;
    std::vector<std::uint32_t> moving;
  };
  // What ends a search before its end, besides the sink.
  struct Stopping {
    Budget budget;
    std::uint64_t tests = 0;
    std::size_t steps = std::numeric_limits<std::size_t>::max();  // that are whole

    // Whether to stop, with something left to do in this step.
    [[nodiscard]] bool now(std::size_t step) noexcept {
      const bool over = tests >= budget.sphere_tests || budget.is_past();
      if (over) steps = std::min(steps, step);
      return over;
    }
  };
  void set_roots() noexcept;
  [[nodiscard]] bool descend_within(std::size_t step, const SearchPose& pose, ContactSink& sink,
                                    Spending& spending, Known& known) noexcept;
  [[nodiscard]] bool advance_within(std::size_t step, const SearchPose& pose, SearchCursor& cursor,
                                    Spending& spending, Measure& measure) noexcept;

  const SearchPlan& plan_;
  const Kernels& kernels_;
  std::vector<Memory> memory_;
  std::vector<Frontier> frontiers_;  // before each step, and the leaves
  std::unique_ptr<SearchScratch> scratch_;
  static constexpr std::size_t kAllGroups = std::numeric_limits<std::size_t>::max();
  std::size_t groups_at_once_ = kAllGroups;
  Stopping stopping_;
};

}  // namespace ist
