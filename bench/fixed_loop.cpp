// Prints the median time of a fixed loop, µs: figures of two runs compare only as far as these do.
#include "cli/bench/fixed_loop.h"

#include <fmt/format.h>

#include "cli/bench/samples.h"

int main() {
  constexpr int kRuns = 1000;
  ist::cli::Samples times;
  for (int run = 0; run < kRuns; ++run) times.add(ist::cli::run_fixed_loop());
  fmt::print("{:.1f}\n", times.median());
}
