#pragma once

#include <cstddef>
#include <cstdint>

#include "ist/query/pair_cache/pair_cache.h"
#include "ist/query/traversal/search.h"

namespace ist {

/// The search that fills a cache. It may be made in parts, on several threads in turn.
class CacheFiller {
 public:
  /// The pairs that are wanted.
  struct Wanted {
    RelativePose centre;
    SearchPose pose;           ///< `centre`, for all leaf pairs within `extent`
    double extent;             ///< mesh units
    Measured measured;         ///< kUpper to bound the distance, if the cache comes out empty
    std::uint64_t most_tests;  ///< the search is given up after these
  };

  /// Reserves the memory of a Search.
  CacheFiller(const SearchPlan& plan, const Kernels& kernels, std::size_t frontier_pairs,
              std::size_t items = 0)
      : search_(plan, kernels, frontier_pairs, items), position_(search_.roots()) {}

  /// Call after the plan was made anew, for other trees.
  void bind() noexcept {
    search_.bind();
    position_ = search_.roots();
  }

  /// Begins a search for `cache`, which stays the caller's.
  void begin(PairCache& cache, const Wanted& wanted) noexcept;
  /// Searches on until it is whole, full, or at the end of the budget, which is for this call
  /// alone. Does nothing if it is whole or full already. Call begin() first.
  void advance(const Budget& budget) noexcept;

  /// Returns whether the cache holds all pairs.
  [[nodiscard]] bool is_whole() const noexcept { return position_.is_end(); }
  /// Returns whether the cache had no room for all pairs, or the search needs too many tests.
  [[nodiscard]] bool is_full() const noexcept { return full_; }
  [[nodiscard]] std::uint64_t most_tests() const noexcept { return wanted_.most_tests; }
  /// Returns the tests made since begin().
  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }

 private:
  Search search_;
  SearchPosition position_;
  PairCache* cache_ = nullptr;
  Wanted wanted_{};
  DistanceBounds bounds_;
  std::uint64_t tests_ = 0;
  bool full_ = false;
};

}  // namespace ist
