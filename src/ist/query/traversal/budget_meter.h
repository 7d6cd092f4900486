#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "ist/query/results.h"

namespace ist::detail {

/// Reads a clock.
using ReadClock = Budget::Clock::time_point (*)() noexcept;

/// Makes all budgets of the process read another clock, for tests. Returns the clock before.
ReadClock set_budget_clock(ReadClock clock) noexcept;

}  // namespace ist::detail

namespace ist {

/// Counts the tests of a search against its budget. If there is a deadline, it reads the clock
/// before the first test and at least every kUnwatchedTests tests. By default there is no limit.
class BudgetMeter {
 public:
  /// The most tests and leaf pairs between two looks at the clock, if there is a deadline.
  static constexpr std::uint64_t kUnwatchedTests = 500;
  static constexpr std::size_t kUnwatchedPairs = 512;

  BudgetMeter() = default;
  /// Begins after `spent` tests.
  explicit BudgetMeter(const Budget& budget, std::uint64_t spent = 0) noexcept
      : budget_(budget), spent_(spent) {}

  /// Returns the most tests that may be made next; 0 if the budget is spent. If there is a
  /// deadline, reads the clock at each call.
  [[nodiscard]] std::uint64_t allow() noexcept {
    return in_time() ? std::min(left(), next_look_ - spent_) : 0;
  }
  /// Returns whether `tests` more tests may be made at once. If there is a deadline, reads the
  /// clock only if kUnwatchedTests were made since the last look, or would be.
  [[nodiscard]] bool allows(std::uint64_t tests) noexcept {
    return tests <= left() && (spent_ + tests < next_look_ || in_time());
  }
  void spend(std::uint64_t tests) noexcept { spent_ += tests; }

  [[nodiscard]] const Budget& budget() const noexcept { return budget_; }
  [[nodiscard]] bool is_limited() const noexcept { return budget_.is_limited(); }
  /// Returns the most leaf pairs that may be taken at once.
  [[nodiscard]] std::size_t most_pairs() const noexcept {
    return budget_.has_deadline() ? kUnwatchedPairs : std::numeric_limits<std::size_t>::max();
  }
  [[nodiscard]] std::uint64_t spent() const noexcept { return spent_; }
  /// Returns the budget that is left.
  [[nodiscard]] Budget rest() const noexcept { return budget_.within(left()); }

 private:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  [[nodiscard]] std::uint64_t left() const noexcept {
    return budget_.has_tests() ? budget_.tests - std::min(budget_.tests, spent_) : kNever;
  }
  // Reads the clock.
  [[nodiscard]] bool in_time() noexcept {
    next_look_ = budget_.has_deadline() ? spent_ + kUnwatchedTests : kNever;
    return !budget_.is_past();
  }

  Budget budget_;
  std::uint64_t spent_ = 0;
  std::uint64_t next_look_ = 0;  // the clock is read before the tests come to this number
};

}  // namespace ist
