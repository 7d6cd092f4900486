#pragma once

#include <cstdint>

#include "ist/query/results.h"
#include "ist/query/traversal/budget_meter.h"

namespace ist {

/// Counts the tests of a search of clusters against its budget: one for each pair of bounds, and
/// kClusterTests for each pair of clusters whose triangles are compared.
class ClusterBudget {
 public:
  static constexpr std::uint64_t kClusterTests = 16;
  /// With a deadline, the most tests between two looks at the clock.
  static constexpr std::uint64_t kUnwatchedTests = BudgetMeter::kUnwatchedTests;

  ClusterBudget(const Budget& budget, std::uint64_t spent) noexcept
      : budget_(budget), limited_(budget.is_limited()), spent_(spent) {}

  [[nodiscard]] bool is_limited() const noexcept { return limited_; }
  /// Returns whether up to `most` more tests may be made. Reads the clock where there is a deadline
  /// and kUnwatchedTests were made since it was read, or could be.
  [[nodiscard]] bool allows(std::uint64_t most) noexcept {
    if (!limited_) return true;
    if (spent_ > budget_.tests || most > budget_.tests - spent_) return false;
    if (spent_ + most < next_look_) return true;
    next_look_ = spent_ + kUnwatchedTests;
    return !budget_.is_past();
  }
  void spend(std::uint64_t tests) noexcept { spent_ += tests; }
  [[nodiscard]] std::uint64_t spent() const noexcept { return spent_; }

 private:
  Budget budget_;
  bool limited_;
  std::uint64_t spent_, next_look_ = 0;
};

}  // namespace ist
