#pragma once

#include <sys/prctl.h>

namespace ist {

/// Sets the calling thread's timer slack to 1 ns while this object lives, so that timers wake the
/// thread as soon as the machine can. By default Linux delays timers by up to 50 µs to join them.
class ScopedTimerSlack {
 public:
  ScopedTimerSlack() noexcept : saved_(prctl(PR_GET_TIMERSLACK)) { prctl(PR_SET_TIMERSLACK, 1ul); }
  ~ScopedTimerSlack() {
    if (saved_ > 0) prctl(PR_SET_TIMERSLACK, static_cast<unsigned long>(saved_));
  }
  ScopedTimerSlack(const ScopedTimerSlack&) = delete;
  ScopedTimerSlack& operator=(const ScopedTimerSlack&) = delete;

 private:
  int saved_;
};

}  // namespace ist
