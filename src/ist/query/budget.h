#pragma once

#include <chrono>
#include <cstdint>
#include <limits>

#include "ist/base/assert.h"

namespace ist {

/// What a query may spend. With tests alone the answer is the same every time, on every machine.
struct Budget {
  using Clock = std::chrono::steady_clock;

  std::uint64_t sphere_tests = std::numeric_limits<std::uint64_t>::max();
  Clock::time_point deadline = Clock::time_point::max();

  [[nodiscard]] bool has_tests() const noexcept {
    return sphere_tests != std::numeric_limits<std::uint64_t>::max();
  }
  [[nodiscard]] bool has_deadline() const noexcept { return deadline != Clock::time_point::max(); }
  /// Looks at the clock only where it must.
  [[nodiscard]] bool is_past() const noexcept { return has_deadline() && Clock::now() >= deadline; }
};

/// Counts what is spent, and looks at the clock often enough.
class Spending {
 public:
  /// The most tests between two looks at the clock.
  static constexpr std::uint64_t kUnwatched = 500;

  explicit Spending(const Budget& budget) noexcept : budget_(budget) {}

  /// Spends some tests, at most kUnwatched, or none where they are too many or time is over; then
  /// nothing more is to be spent.
  [[nodiscard]] bool spend(std::uint64_t tests) noexcept {
    IST_ASSERT(tests <= kUnwatched);
    if (unwatched_ + tests > kUnwatched || tests_ == 0) {
      unwatched_ = 0;
      over_ = over_ || Budget::Clock::now() >= budget_.deadline;
    }
    over_ = over_ || tests > budget_.sphere_tests - tests_;
    if (over_) return false;
    unwatched_ += tests;
    tests_ += tests;
    return true;
  }
  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }

 private:
  Budget budget_;
  std::uint64_t tests_ = 0;
  std::uint64_t unwatched_ = kUnwatched;  // so that the clock is looked at first of all
  bool over_ = false;
};

}  // namespace ist
