#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "ist/query/results.h"

namespace ist {

/// Counts the tests of a search against its budget, and reads the clock often enough. By default
/// there is no limit.
class BudgetMeter {
 public:
  /// With a deadline, the most tests between two looks at the clock, and the most leaf pairs.
  static constexpr std::uint64_t kUnwatchedTests = 500;
  static constexpr std::size_t kUnwatchedPairs = 512;

  BudgetMeter() = default;
  /// Begins after `spent` tests.
  explicit BudgetMeter(const Budget& budget, std::uint64_t spent = 0) noexcept
      : budget_(budget), spent_(spent) {}

  /// Returns the most tests that may be made next; 0 where the budget is spent. Reads the clock
  /// where there is a deadline.
  [[nodiscard]] std::uint64_t allow() noexcept {
    if (budget_.is_past() || spent_ >= budget_.tests) return 0;
    const std::uint64_t left = budget_.tests - spent_;
    return budget_.has_deadline() ? std::min(left, kUnwatchedTests) : left;
  }
  void spend(std::uint64_t tests) noexcept { spent_ += tests; }

  [[nodiscard]] const Budget& budget() const noexcept { return budget_; }
  /// Returns the most leaf pairs that may be taken at once.
  [[nodiscard]] std::size_t most_pairs() const noexcept {
    return budget_.has_deadline() ? kUnwatchedPairs : std::numeric_limits<std::size_t>::max();
  }
  [[nodiscard]] std::uint64_t spent() const noexcept { return spent_; }

 private:
  Budget budget_;
  std::uint64_t spent_ = 0;
};

}  // namespace ist
