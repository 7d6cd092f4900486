#pragma once

#include <chrono>
#include <cstdint>

#include "ist/query/traversal/budget_meter.h"

namespace ist::test {

/// Makes all budgets read another clock while it lives.
class ScopedBudgetClock {
 public:
  explicit ScopedBudgetClock(detail::ReadClock clock) noexcept
      : before_(detail::set_budget_clock(clock)) {}
  ~ScopedBudgetClock() { detail::set_budget_clock(before_); }
  ScopedBudgetClock(const ScopedBudgetClock&) = delete;
  ScopedBudgetClock& operator=(const ScopedBudgetClock&) = delete;

 private:
  detail::ReadClock before_;
};

/// A clock that stands still and counts how often it is read.
struct FakeClock {
  static Budget::Clock::time_point now() noexcept {
    ++looks;
    return {};
  }
  static inline std::uint64_t looks;
};

/// A clock that is late from one look on.
struct LateClock {
  static Budget::Clock::time_point now() noexcept {
    return Budget::Clock::time_point(std::chrono::nanoseconds(looks++ < allowed ? 0 : 2));
  }
  /// Returns a budget whose deadline has passed after `looks_allowed` looks at this clock, if
  /// budgets read it.
  static Budget budget_of(int looks_allowed) {
    looks = 0;
    allowed = looks_allowed;
    return {.deadline = Budget::Clock::time_point(std::chrono::nanoseconds(1))};
  }
  static inline int looks, allowed;
};

}  // namespace ist::test
