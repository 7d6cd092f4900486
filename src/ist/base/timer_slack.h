#pragma once

#include <sys/prctl.h>

namespace ist {

/// While it lives, timers of the calling thread wake it as late as the machine makes them, and not
/// 50 µs later still, which is how far Linux otherwise lets them slip to join others.
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
