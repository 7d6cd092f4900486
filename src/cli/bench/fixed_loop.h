#pragma once

#include <chrono>
#include <cstdint>

namespace ist::cli {

/// The steps of the fixed loop.
inline constexpr int kFixedLoopSteps = 100'000;

/// Runs a fixed loop of whole numbers, each of which needs the one before it, and returns its time
/// in microseconds. It reads no memory, so its time changes only with the clock of the core and
/// with other work on it: figures that stand beside equal times were made at equal speed. Cost: 0.1
/// to 0.3 ms. Source of the steps: G. Marsaglia, Xorshift RNGs, J. Statistical Software 8(14),
/// 2003.
[[nodiscard]] inline double run_fixed_loop() {
  static volatile std::uint64_t seed = 88172645463325252;
  std::uint64_t x = seed;
  const auto begin = std::chrono::steady_clock::now();
  for (int step = 0; step < kFixedLoopSteps; ++step) {
    x ^= x << 13;
    x ^= x >> 7;
    x ^= x << 17;
  }
  const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
  seed = x;
  return time.count();
}

}  // namespace ist::cli
