#pragma once

#include <sched.h>

#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/timer_slack.h"

namespace ist {

/// What a loop asks of the system.
struct RealTimeOptions {
  int priority = 80;                      ///< under SCHED_FIFO, from 1 to 99
  std::optional<int> cpu = std::nullopt;  ///< the one processor to stay on, counted from 0
  bool lock_memory = true;                ///< keep all memory of the process present
};

/// While it lives, the calling thread keeps its beat as well as the system permits: it goes before
/// all ordinary threads (SCHED_FIFO), its timers do not slip, it stays on one processor where one
/// is named, and no page of the process, nor of its stack, has to be fetched (mlockall). Whatever
/// is not permitted is done without, and said in notes().
///
/// Threads that it makes meanwhile begin with its scheduling and its processor: the second worker
/// of a query, and whatever else must not compete with it, are made before.
///
/// Made and destroyed by the same thread, outside the ticks. Memory is locked and unlocked for the
/// whole process: of several of these, only the last one to go should have been asked to.
class IST_API RealTimeThread {
 public:
  /// Cost: a few system calls, and where memory is locked the time to fetch all of the process that
  /// is not yet present. Throws std::bad_alloc, and then nothing was changed.
  explicit RealTimeThread(const RealTimeOptions& options);
  /// Puts back the scheduling and the processors that the thread had, and unlocks the memory. What
  /// the system no longer permits, such as processors taken away meanwhile, stays as it is.
  ~RealTimeThread();
  RealTimeThread(const RealTimeThread&) = delete;
  RealTimeThread& operator=(const RealTimeThread&) = delete;

  [[nodiscard]] bool fifo() const noexcept { return policy_.has_value(); }
  [[nodiscard]] bool memory_locked() const noexcept { return memory_locked_; }
  [[nodiscard]] bool pinned() const noexcept { return affinity_.has_value(); }

  /// A sentence for people for each thing that was asked for and not permitted, with its cause and
  /// its remedy.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  struct Policy {
    int policy;
    int priority;
  };

  RealTimeThread() = default;
  IST_LOCAL void ask_for_fifo(int priority);
  IST_LOCAL void ask_for_memory();
  IST_LOCAL void ask_for_cpu(int cpu);

  std::thread::id owner_ = std::this_thread::get_id();
  ScopedTimerSlack slack_;
  // What to put back.
  std::optional<Policy> policy_;
  std::optional<cpu_set_t> affinity_;
  bool memory_locked_ = false;
  std::vector<std::string> notes_;
};

}  // namespace ist
