#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ist/query/bound_lanes.h"
#include "ist/query/search_plan.h"

namespace ist {

/// Where contacts go: the first of them into a span, all of them into the count.
class ContactSink {
 public:
  explicit ContactSink(std::span<Contact> out) noexcept : out_(out) {}

  /// Appends the pairs of a frontier of leaves.
  void append(const Frontier& leaves, const Kernels& kernels, const SearchPlan& plan) noexcept;
  /// Appends contacts that another sink took.
  void append(std::span<const Contact> contacts) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] bool truncated() const noexcept { return count_ > out_.size(); }

 private:
  std::span<Contact> out_;
  std::uint64_t count_ = 0;
};

/// The memory of a search and the way through it: breadth first, one frontier a step. A frontier
/// that is full is searched down to the leaves before it is filled again, so that memory is bounded
/// and the order of contacts stays. One belongs to one thread.
class Search {
 public:
  /// Reserves all memory: per step 12 bytes for each of `pairs`, or for each moving node at its
  /// level, where there are more of those, or for every pair of nodes, where there are fewer.
  Search(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs);

  /// Searches from the pair of the roots down to the leaves. Returns the number of pairs tested.
  std::uint64_t run(const SearchPose& pose, ContactSink& sink) noexcept;

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

  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  struct Memory {
    std::vector<SearchGroup> groups;
    std::vector<std::uint32_t> moving;
  };
  void set_roots() noexcept;

  const SearchPlan& plan_;
  const Kernels& kernels_;
  std::vector<Memory> memory_;
  std::vector<Frontier> frontiers_;  // before each step, and the leaves
  std::unique_ptr<SearchScratch> scratch_;
};

}  // namespace ist
