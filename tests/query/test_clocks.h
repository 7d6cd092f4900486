#pragma once

#include <chrono>
#include <cstdint>

#include "ist/query/results.h"

namespace ist::test {

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
  /// Returns a budget whose deadline has passed after `looks_allowed` looks.
  static Budget budget_of(int looks_allowed) {
    looks = 0;
    allowed = looks_allowed;
    return {.deadline = Budget::Clock::time_point(std::chrono::nanoseconds(1)), .now = now};
  }
  static inline int looks, allowed;
};

}  // namespace ist::test
