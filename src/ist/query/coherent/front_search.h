#pragma once

#include <cstddef>
#include <cstdint>

#include "ist/query/coherent/front.h"
#include "ist/query/traversal/search.h"

namespace ist {

/// The search that fills a front. It may be made in parts, by one thread or another.
class FrontSearch {
 public:
  enum class State : std::uint8_t {
    kNone,      ///< none is wanted
    kUnderWay,  ///< begun, or to begin
    kDone,      ///< the front is whole
    kFull,      ///< the front had no room for all pairs, or the tests were too many
  };
  /// The pairs wanted, and the search for them.
  struct Wanted {
    RelativePose centre;
    SearchPose pose;    ///< `centre`, for all leaf pairs within `extent`
    double extent;      ///< mesh units
    Measured measured;  ///< kUpper to bound the distance, if the front comes out empty
    std::uint64_t most_tests;
  };

  /// Reserves the memory of a Search.
  FrontSearch(const SearchPlan& plan, const Kernels& kernels, std::size_t frontier_pairs)
      : search_(plan, kernels, frontier_pairs), position_(search_.roots()) {}

  /// Begins a search for `front`, which stays the caller's.
  void begin(Front& front, const Wanted& wanted) noexcept;
  /// Goes on with it within a budget, of this part alone, and a deadline.
  State advance(const Budget& budget) noexcept;
  void drop() noexcept { state_ = State::kNone; }

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] const Front& front() const noexcept { return *front_; }
  [[nodiscard]] std::uint64_t most_tests() const noexcept { return wanted_.most_tests; }
  /// Returns the tests made since begin().
  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }

 private:
  Search search_;
  SearchPosition position_;
  Front* front_ = nullptr;
  Wanted wanted_{};
  DistanceBounds bounds_;
  std::uint64_t tests_ = 0;
  State state_ = State::kNone;
};

}  // namespace ist
