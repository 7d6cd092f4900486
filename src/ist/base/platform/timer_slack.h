#pragma once

#if defined(__linux__)
#include <sys/prctl.h>
#endif

namespace ist {

/// Sets the calling thread's timer slack to 1 ns while this object lives, so that timers wake the
/// thread as soon as the machine can. By default Linux delays timers by up to 50 µs to join them;
/// other systems have no such setting.
class ScopedTimerSlack {
 public:
  ScopedTimerSlack() noexcept : saved_(read()) { write(1); }
  ~ScopedTimerSlack() {
    if (saved_ > 0) write(static_cast<unsigned long>(saved_));
  }
  ScopedTimerSlack(const ScopedTimerSlack&) = delete;
  ScopedTimerSlack& operator=(const ScopedTimerSlack&) = delete;

 private:
#if defined(__linux__)
  static int read() noexcept { return prctl(PR_GET_TIMERSLACK); }
  static void write(unsigned long slack) noexcept { prctl(PR_SET_TIMERSLACK, slack); }
#else
  static int read() noexcept { return 0; }
  static void write(unsigned long) noexcept {}
#endif
  int saved_;
};

}  // namespace ist
