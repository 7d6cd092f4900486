#include "ist/base/parallel.h"

#include <algorithm>
#include <atomic>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"

namespace ist {
namespace {

// These atomics repeat TBB's memory ordering for race detectors that cannot see into TBB: writes
// before a loop are visible in each of its ranges, and writes of the ranges are visible after the
// loop.
std::atomic<std::size_t> loops_begun{0};

// A loop over ranges. A range counts as ended where its body throws, too.
struct Loop {
  std::size_t count, grain;
  const std::function<void(std::size_t, std::size_t)>& body;
  std::atomic<std::size_t> ranges_ended{0};

  ~Loop() { static_cast<void>(ranges_ended.load(std::memory_order_acquire)); }

  void run(std::size_t range) {
    const End end{ranges_ended};
    const ScopedFloatEnvironment environment;
    body(range * grain, std::min(count, (range + 1) * grain));
  }

 private:
  struct End {
    std::atomic<std::size_t>& ranges_ended;
    ~End() { ranges_ended.fetch_add(1, std::memory_order_release); }
  };
};

}  // namespace

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  IST_ASSERT(grain > 0);
  Loop loop{count, grain, body};
  loops_begun.fetch_add(1, std::memory_order_release);
  run_ranges((count + grain - 1) / grain,
             [](void* context, std::size_t range) {
               static_cast<void>(loops_begun.load(std::memory_order_acquire));
               static_cast<Loop*>(context)->run(range);
             },
             &loop);
}

void parallel_sort(std::span<std::uint64_t> keys) {
  constexpr std::size_t kSmallest = 1 << 14;  // sorted before another thread would start
  std::size_t run = std::max(kSmallest, (keys.size() + 15) / 16);
  parallel_for(keys.size(), run, [keys](std::size_t begin, std::size_t end) {
    std::sort(keys.begin() + static_cast<std::ptrdiff_t>(begin),
              keys.begin() + static_cast<std::ptrdiff_t>(end));
  });
  for (; run < keys.size(); run *= 2) {
    parallel_for(keys.size(), 2 * run, [keys, run](std::size_t begin, std::size_t end) {
      const auto first = keys.begin() + static_cast<std::ptrdiff_t>(begin);
      std::inplace_merge(first, first + static_cast<std::ptrdiff_t>(std::min(run, end - begin)),
                         keys.begin() + static_cast<std::ptrdiff_t>(end));
    });
  }
}

}  // namespace ist
