#pragma once

#include <chrono>
#include <thread>

namespace ist::bench {

/// Lets ticks begin a period apart, as a servo loop does: sleeps until just before each, then
/// polls.
class Pacer {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Pacer(std::chrono::nanoseconds period) : period_(period), next_(Clock::now() + period) {}

  void wait() {
    std::this_thread::sleep_until(next_ - std::chrono::microseconds(150));
    while (Clock::now() < next_) {
    }
    next_ = std::max(next_ + period_, Clock::now());
  }

 private:
  std::chrono::nanoseconds period_;
  Clock::time_point next_;
};

}  // namespace ist::bench
