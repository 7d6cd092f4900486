#pragma once

#include <array>
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

// Until `done`, or for a minute: a machine that is busy is no failure.
inline bool eventually(const std::function<bool()>& done) {
  for (const auto give_up = Clock::now() + 60s; Clock::now() < give_up;) {
    if (done()) return true;
    std::this_thread::sleep_for(10us);
  }
  return false;
}

inline bool offered(ResidentWorker& worker, Job& job) {
  return eventually([&] {
    worker.tick(Clock::now(), 0ns);
    return worker.offer(job);
  });
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
    while (const auto chunk = sum.board.claim_back(sum.epoch)) {
      hand_over(HandOver::kClaimed);
      sum.parts[*chunk] = part(*chunk);
      hand_over(HandOver::kWorked);
      if (!sum.board.complete(sum.epoch, *chunk)) return;
    }
  }
  static std::uint64_t part(std::size_t chunk) { return chunk * chunk; }

  ~Sum() { job.wait_idle(); }

  // Returns the sum, done by the caller as far as the worker does not come.
  std::uint64_t with(ResidentWorker& worker) {
    helped = false;
    if (job.busy()) return without();
    epoch = board.open(kChunks);
    const bool offered = worker.offer(job);
    std::array<std::uint64_t, kChunks> own{};
    while (const auto chunk = board.claim_front()) own[*chunk] = part(*chunk);
    for (std::size_t i = board.close(); i < kChunks; ++i)
      own[i] = board.collect(i, 200us) ? parts[i] : part(i);
    helped = offered && !worker.retract(job);
    return std::accumulate(own.begin(), own.end(), std::uint64_t{0});
  }
  static std::uint64_t without() {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < kChunks; ++i) sum += part(i);
    return sum;
  }

  SplitQueue board{kChunks};
  std::array<std::uint64_t, kChunks> parts{};
  std::uint64_t epoch = 0;
  bool helped = false;  // the worker entered the last one
  Job job{help, this};
};

}  // namespace ist::test
