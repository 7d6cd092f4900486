#pragma once

#include <sched.h>

#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "ist/base/platform/timer_slack.h"
#include "ist/haptics/servo_loop.h"

namespace ist {

/// Gives the calling thread real-time scheduling for its lifetime, as far as the system permits:
/// SCHED_FIFO, exact timers, one processor if one is named, and locked memory, stack included. A
/// denied request is noted in notes().
///
/// Threads that it starts meanwhile inherit its scheduling and processor: start threads that must
/// not compete with it, such as the second worker of a query, before.
///
/// Construct and destroy it in the same thread, outside ticks. Memory is locked and unlocked for
/// the whole process: of several objects, only the last one to be destroyed should lock it.
class RealTimeThread {
 public:
  /// Cost: a few system calls, and the time to fetch all pages of the process if memory is locked.
  /// Throws std::bad_alloc, and then changes nothing.
  explicit RealTimeThread(const RealTimeOptions& options);
  /// Restores the thread's scheduling and processors, and unlocks the memory. A change that the
  /// system no longer permits is skipped.
  ~RealTimeThread();
  RealTimeThread(const RealTimeThread&) = delete;
  RealTimeThread& operator=(const RealTimeThread&) = delete;

  [[nodiscard]] bool fifo() const noexcept { return policy_.has_value(); }
  [[nodiscard]] bool memory_locked() const noexcept { return memory_locked_; }
  [[nodiscard]] bool pinned() const noexcept { return affinity_.has_value(); }

  /// One sentence for each denied request, with its cause and its remedy.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  struct Policy {
    int policy;
    int priority;
  };

  RealTimeThread() = default;
  void ask_for_fifo(int priority);
  void ask_for_memory();
  void ask_for_cpu(int cpu);

  std::thread::id owner_ = std::this_thread::get_id();
  ScopedTimerSlack slack_;
  // The state to restore.
  std::optional<Policy> policy_;
  std::optional<cpu_set_t> affinity_;
  bool memory_locked_ = false;
  std::vector<std::string> notes_;
};

}  // namespace ist
