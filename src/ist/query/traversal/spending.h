#pragma once

#include "ist/base/assert.h"
#include "ist/query/results.h"

namespace ist {

/// Counts the tests of a search against its budget, and reads the clock often enough.
class Spending {
 public:
  /// The most tests between two looks at the clock.
  static constexpr std::uint64_t kUnwatched = 500;

  explicit Spending(const Budget& budget) noexcept : budget_(budget) {}

  /// Spends at most kUnwatched tests. Returns false, and spends none, where they exceed the budget
  /// or the deadline has passed; then nothing more may be spent.
  [[nodiscard]] bool spend(std::uint64_t tests) noexcept {
    IST_ASSERT(tests <= kUnwatched);
    if (unwatched_ + tests > kUnwatched || tests_ == 0) {
      unwatched_ = 0;
      over_ = over_ || Budget::Clock::now() >= budget_.deadline;
    }
    over_ = over_ || tests > budget_.tests - tests_;
    if (over_) return false;
    unwatched_ += tests;
    tests_ += tests;
    return true;
  }
  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }

 private:
  Budget budget_;
  std::uint64_t tests_ = 0;
  std::uint64_t unwatched_ = kUnwatched;  // so that the first call reads the clock
  bool over_ = false;
};

}  // namespace ist
