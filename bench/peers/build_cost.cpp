#include "peers/build_cost.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>

#include "support/bodies.h"
#include "support/peak_memory.h"

namespace ist::bench {
namespace {

// In arenas, and mapped for large blocks.
double allocated_mb() {
  const struct mallinfo2 info = mallinfo2();
  return 1e-6 * static_cast<double>(info.uordblks + info.hblkhd);
}

// What is in memory now: the peak since a moment ago.
double resident_mb() {
  reset_peak_memory();
  return peak_memory_mb();
}

}  // namespace

BuildCost measure_build(const Library& library, int rounds, Peers& built) {
  const TriangleMesh &fixed = upper_jaw(), &moving = lower_jaw();  // read before the time begins
  BuildCost cost;
  for (; cost.rounds < rounds; ++cost.rounds) {
    built.clear();
    const double resident = resident_mb(), allocated = allocated_mb();
    const auto begin = std::chrono::steady_clock::now();
    built = library.make(fixed, moving);
    cost.times.add(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
            .count());
    cost.peak_mb = std::max(cost.peak_mb, peak_memory_mb() - resident);
    cost.held_mb = std::max(cost.held_mb, allocated_mb() - allocated);
    cost.grown_mb = std::max(cost.grown_mb, resident_mb() - resident);
  }
  return cost;
}

}  // namespace ist::bench
