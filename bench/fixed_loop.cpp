// Prints the median time of a fixed loop, µs: figures of two runs compare only as far as these do.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

namespace {

constexpr int kSteps = 100'000, kRuns = 1000;

// Returns the time of whole numbers that each need the one before. The loop reads no memory, so its
// time changes only with the clock of the core and with other work on it. Source of the steps: G.
// Marsaglia, Xorshift RNGs, J. Statistical Software 8(14), 2003.
double run_fixed_loop() {
  static volatile std::uint64_t seed = 88172645463325252;
  std::uint64_t x = seed;
  const auto begin = std::chrono::steady_clock::now();
  for (int step = 0; step < kSteps; ++step) {
    x ^= x << 13;
    x ^= x >> 7;
    x ^= x << 17;
  }
  const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
  seed = x;
  return time.count();
}

}  // namespace

int main() {
  std::vector<double> times;
  for (int run = 0; run < kRuns; ++run) times.push_back(run_fixed_loop());
  std::ranges::nth_element(times, times.begin() + kRuns / 2);
  fmt::print("{:.1f}\n", times[kRuns / 2]);
}
