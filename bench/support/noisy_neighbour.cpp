#include "support/noisy_neighbour.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>

namespace ist::bench {

NoisyNeighbour::NoisyNeighbour(bool there) {
  constexpr std::size_t kBlock = 4096, kBlocks = kMegabytes * 1'000'000 / sizeof(double) / kBlock;
  if (!there) return;
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  for (unsigned i = 0; i < cores; ++i) {
    threads_.emplace_back([this] {
      std::vector<double> numbers(kBlocks * kBlock, 1.0);
      at_work_.fetch_add(1);
      for (std::size_t block = 0; !stop_.load(std::memory_order_relaxed); ++block) {
        double* const first = numbers.data() + block % kBlocks * kBlock;
        for (std::size_t n = 0; n < kBlock; ++n) first[n] = 0.75 * first[n] + 0.5;
      }
      benchmark::DoNotOptimize(numbers.data());
    });
  }
  while (at_work_.load() < cores) std::this_thread::yield();
}

NoisyNeighbour::~NoisyNeighbour() {
  stop_.store(true);
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace ist::bench
