#pragma once

#include "ist/query/results.h"

namespace ist::detail {

/// Reads a clock.
using ReadClock = Budget::Clock::time_point (*)() noexcept;

/// Makes all budgets of the process read another clock, for tests. Returns the clock before.
ReadClock set_budget_clock(ReadClock clock) noexcept;

}  // namespace ist::detail
