#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "ist/base/parallel.h"

namespace ist {

/// A piece of work that its owner, a query, may offer to the resident worker again and again. Must
/// not be destroyed while busy().
class Job {
 public:
  using Run = void (*)(void* context) noexcept;

  Job(Run run, void* context) noexcept;
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// Returns whether the job was offered, and neither retracted nor completed. Once this is false,
  /// everything the worker wrote is visible.
  [[nodiscard]] bool busy() const noexcept { return busy_.load(std::memory_order_acquire); }

  /// Waits until the job is not busy, however long that takes, but in a child process after fork(),
  /// which has no worker, not at all. Sleeps: for destructors, after retract(), not for queries.
  void wait_idle() const noexcept;

 private:
  friend class ResidentWorker;
  friend class WorkerLoop;
  Run run_;
  void* context_;
  int process_;
  std::atomic<bool> busy_{false};
};

/// A thread beside the caller's. Number 0 is for every query of the process that has two workers,
/// and for every World with threads; the others are for worlds alone. TBB lends a thread while at
/// least one ResidentWorker object of its number lives.
///
/// Waking a sleeping thread is a system call and takes 50 to 150 µs, more than most queries. So no
/// caller wakes this thread: it sleeps by a timer of its own until just before a tick is expected,
/// and then polls (worker_schedule.h). A query with work to share offers it; if the worker does not
/// poll at that moment, the query does the work itself. Where TBB has no thread to lend, no offer
/// succeeds; in a child process after fork() no job is ever entered.
///
/// Offer the job again before each chunk: a refused offer is cheap. With back-to-back long ticks
/// the worker starts polling in the middle of a tick, so a single early offer would always miss it.
///
/// tick(), offer() and retract() access only atomics: no lock, no allocation, no system call; 1 to
/// 10 ns, and 100 where the worker is polling. Several threads may call them. An empty job ends 0.4
/// µs after its offer.
class ResidentWorker {
 public:
  /// The number of workers.
  static constexpr std::size_t kMost = 15;

  /// Asks TBB for the thread, if no other object of its number has; it is there 0.1 ms later, or
  /// when TBB has one to lend. Throws std::bad_alloc, and then no worker of this number comes as
  /// long as the process lives. Precondition: number < kMost.
  explicit ResidentWorker(std::size_t number = 0);

  /// The last object waits until the thread has left, a nap of up to 10 ms. Precondition: no job
  /// offered through it is busy.
  ~ResidentWorker();

  ResidentWorker(const ResidentWorker&) = delete;
  ResidentWorker& operator=(const ResidentWorker&) = delete;

  /// Reports that a tick begins.
  ///
  /// @param now    when it began
  /// @param period the time to the next tick; 0 when they follow back to back. Of several callers
  ///               the last one to report counts.
  void tick(std::chrono::steady_clock::time_point now, std::chrono::nanoseconds period) noexcept;

  /// Hands `job` to the worker if it polls right now and holds no other offer. Returns false at
  /// once otherwise, and when the job is still busy. If true, the worker calls `run(context)` in
  /// ScopedFloatEnvironment and sees everything written before.
  [[nodiscard]] bool offer(Job& job) noexcept;

  /// Takes back an offered job. Returns true if the worker never entered it, false if it has
  /// entered it and may have completed it.
  bool retract(Job& job) noexcept;

  /// The time that the worker was there since the process began, and the part of it on a core.
  /// Updated before each sleep and every millisecond of polling.
  struct Usage {
    std::chrono::nanoseconds wall{0}, cpu{0};
  };
  [[nodiscard]] static Usage usage() noexcept;

  /// Returns whether the thread of number 0 is there. After the last object is gone it leaves
  /// within a nap.
  [[nodiscard]] static bool is_there() noexcept;

 private:
  std::size_t number_;
  // One thread more than TBB would have, so that the loops of a build do not lose one.
  ScopedThreadLimit limit_{thread_count() + 1};
};

/// The points at which a worker can be late, in order.
enum class HandOver : std::uint8_t {
  kSeen,     ///< a job found, not entered
  kEntered,  ///< the job entered, no chunk claimed
  kClaimed,  ///< a chunk claimed, not begun
  kWorked,   ///< the chunk done, not reported
};

/// A test's hook, called at each HandOver point on the worker's thread, to stall it there. Only the
/// worker reads it: one load of a cache line that nobody writes.
inline std::atomic<void (*)(HandOver) noexcept> hand_over_hook{nullptr};

/// A test's schedule in place of that of worker_schedule.h: while this is true the worker polls all
/// the time, so that every offer finds it awake. Only the worker reads it.
inline std::atomic<bool> always_awake{false};

/// The number of naps of all Job::wait_idle() calls so far. A test sees by it that a thread waits.
inline std::atomic<std::uint64_t> idle_naps{0};

/// Calls the hook for the point `at`. Jobs call it for kClaimed and kWorked.
inline void hand_over(HandOver at) noexcept {
  if (const auto hook = hand_over_hook.load(std::memory_order_acquire)) hook(at);
}

}  // namespace ist
