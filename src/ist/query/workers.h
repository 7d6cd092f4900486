#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include "ist/base/tbb_ranges.h"

namespace ist {

/// A piece of work that its owner, a query, may offer to the resident worker again and again. Must
/// not be destroyed while busy().
class Job {
 public:
  using Run = void (*)(void* context) noexcept;

  Job(Run run, void* context) noexcept : run_(run), context_(context) {}
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// Whether it was offered, and neither retracted nor ended by the worker. Once false, all that
  /// the worker wrote is seen.
  [[nodiscard]] bool busy() const noexcept { return busy_.load(std::memory_order_acquire); }

  /// Waits until it is not busy, for as long as that takes. Sleeps: for destructors, not for
  /// queries, and after retract().
  void wait_idle() const noexcept;

 private:
  friend class ResidentWorker;
  friend class WorkerLoop;
  Run run_;
  void* context_;
  std::atomic<bool> busy_{false};
};

/// One thread beside the caller's, for every query of the process that has two workers. It is one
/// of TBB's, taken while at least one ResidentWorker object lives.
///
/// Waking a sleeping thread is a system call and takes 50 to 150 µs, more than most queries. So
/// nobody wakes this one: it sleeps by a timer of its own until just before a tick is expected, and
/// then polls (see worker_schedule.h). When a query has work to share it offers it, and if the
/// worker does not happen to poll at that moment the query does the work itself. Where TBB has no
/// thread to give, no offer succeeds; in a child process after fork() no job is ever entered.
///
/// A refused offer is cheap, and a query does well to make it again before each piece of its work:
/// the worker polls for a while after each tick that it notices, but where long ticks follow back
/// to back that is in their midst, and no first offer would ever find it.
///
/// tick(), offer() and retract() touch atomics and nothing else: no lock, no allocation, no system
/// call; 1 to 10 ns, and 100 where the worker is polling. They may be called by several threads. A
/// job begins and ends 0.4 µs after it was offered if there is nothing in it.
class ResidentWorker {
 public:
  /// Takes a thread, if no other object has; it is there 0.1 ms later or when TBB has one to give.
  /// Throws std::bad_alloc, and then no worker comes as long as the process lives.
  ResidentWorker();

  /// The last one waits until the thread has left, a nap of up to 10 ms. No job that was offered
  /// through it may be busy.
  ~ResidentWorker();

  ResidentWorker(const ResidentWorker&) = delete;
  ResidentWorker& operator=(const ResidentWorker&) = delete;

  /// A tick begins.
  ///
  /// @param now    when it began
  /// @param period how soon after it the next one is expected; 0 when they follow back to back. Of
  ///               several callers the last one to report counts.
  void tick(std::chrono::steady_clock::time_point now, std::chrono::nanoseconds period) noexcept;

  /// Hands `job` to the worker if it polls right now and was offered nothing else. False at once
  /// otherwise, and when the job is still busy. If true, the worker calls `run(context)` in
  /// ScopedFloatEnvironment, and sees what was written before.
  [[nodiscard]] bool offer(Job& job) noexcept;

  /// Takes back a job that was offered. True: the worker never entered it. False: it has entered
  /// it, and may have ended it.
  bool retract(Job& job) noexcept;

  /// What the worker has used since the process began: the time it was there, and how much of it on
  /// a core. Brought up to date before each sleep and every millisecond of polling.
  struct Usage {
    std::chrono::nanoseconds wall{0}, cpu{0};
  };
  [[nodiscard]] static Usage usage() noexcept;

 private:
  // One thread more than TBB would have, so that this one is not missing in the loops of a build.
  TbbThreadLimit limit_{tbb_threads() + 1};
};

/// The points at which a worker can be late, in order.
enum class HandOver : std::uint8_t {
  kSeen,     ///< it has found a job, and not entered it
  kEntered,  ///< it has entered it, and claimed nothing
  kClaimed,  ///< it has claimed a chunk, and not begun it
  kWorked,   ///< it has done the chunk, and not reported it
};

/// Called at each of them, on the worker's thread, for a test to stall it there. Only the worker
/// reads it, never a caller; and there it is one load of a line that nobody writes.
inline std::atomic<void (*)(HandOver) noexcept> hand_over_hook{nullptr};

/// The worker is at `at`. Jobs call it for kClaimed and kWorked.
inline void hand_over(HandOver at) noexcept {
  if (const auto hook = hand_over_hook.load(std::memory_order_acquire)) hook(at);
}

}  // namespace ist
