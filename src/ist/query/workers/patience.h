#pragma once

#include <algorithm>
#include <chrono>

#include "ist/query/results.h"

namespace ist {

/// Returns the time that a caller, when done, waits for the worker's last chunk: 20 µs, but not
/// past a deadline.
[[nodiscard]] inline std::chrono::nanoseconds patience(const Budget& budget) noexcept {
  constexpr std::chrono::microseconds kPatience{20};
  if (!budget.has_deadline()) return kPatience;
  return std::min<std::chrono::nanoseconds>(kPatience, budget.deadline - budget.now());
}

}  // namespace ist
