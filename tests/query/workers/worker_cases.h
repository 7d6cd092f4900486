#pragma once

#include <xmmintrin.h>

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <numeric>
#include <thread>

#include "ist/query/workers/resident_worker.h"
#include "ist/query/workers/split_queue.h"

// Owners of work for the resident worker, for its tests.
namespace ist::test {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// Waits without a limit: on a busy machine it takes longer, and is no failure.
inline void wait_until(const std::function<bool()>& done) {
  while (!done()) std::this_thread::sleep_for(10us);
}

// Returns when the worker has taken the job.
inline void offer_until_taken(ResidentWorker& worker, Job& job) {
  wait_until([&] {
    worker.tick(Clock::now(), 0ns);
    return worker.offer(job);
  });
}

// Returns when the job is done. Spins, so that an idle machine hands over as a query does, and then
// leaves the core to the worker.
inline void wait_spinning(const Job& job) {
  for (int i = 0; i < 10'000 && job.busy(); ++i) _mm_pause();
  job.wait_idle();
}

// Adds one to a number that is not atomic: the job orders it.
struct Counting {
  static void run(void* context) noexcept { ++static_cast<Counting*>(context)->runs; }
  ~Counting() { job.wait_idle(); }
  int runs = 0;
  Job job{run, this};
};

// Sums squares with the worker's help, as a query divides a level.
struct Sum {
  static constexpr std::size_t kChunks = 64;

  static void help(void* context) noexcept {
    auto& sum = *static_cast<Sum*>(context);
    sum.entered = true;
    while (const auto chunk = sum.queue.claim_back(sum.epoch)) {
      hand_over(HandOver::kClaimed);
      sum.parts[*chunk] = part(*chunk);
      hand_over(HandOver::kWorked);
      if (!sum.queue.complete(sum.epoch, *chunk)) return;
    }
  }
  static std::uint64_t part(std::size_t chunk) { return chunk * chunk; }

  ~Sum() { job.wait_idle(); }

  // Returns the sum, done by the caller as far as the worker does not come. Calls `meet` before the
  // first chunk, if the worker has taken the offer.
  template <class Meet>
  std::uint64_t with(ResidentWorker& worker, const Meet& meet) {
    helped = false;
    if (job.busy()) return without();
    epoch = queue.open(kChunks);
    entered = false;
    const bool offered = worker.offer(job);
    if (offered) meet();
    std::array<std::uint64_t, kChunks> own{};
    while (const auto chunk = queue.claim_front()) own[*chunk] = part(*chunk);
    for (std::size_t i = queue.close(); i < kChunks; ++i)
      own[i] = queue.collect(i, 200us) ? parts[i] : part(i);
    helped = offered && !worker.retract(job);
    return std::accumulate(own.begin(), own.end(), std::uint64_t{0});
  }
  std::uint64_t with(ResidentWorker& worker) {
    return with(worker, [] {});
  }
  // The worker enters every offer that it takes. Makes no system call.
  std::uint64_t with_help(ResidentWorker& worker) {
    return with(worker, [this] {
      while (!entered) _mm_pause();
    });
  }
  static std::uint64_t without() {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < kChunks; ++i) sum += part(i);
    return sum;
  }

  SplitQueue queue{kChunks};
  std::array<std::uint64_t, kChunks> parts{};
  std::uint64_t epoch = 0;
  bool helped = false;  // the worker entered the last one
  std::atomic<bool> entered{false};
  Job job{help, this};
};

}  // namespace ist::test
