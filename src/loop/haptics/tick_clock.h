#pragma once

#include <chrono>
#include <cstdint>

namespace ist {

/// The start of a tick.
struct TickStart {
  std::chrono::nanoseconds late;  ///< release jitter: from the tick's release to its start
  std::uint64_t missed;           ///< ticks skipped before it
};

/// Schedules ticks at a start and every period after it, so that lateness does not accumulate. A
/// tick whose time has passed is skipped: missed ticks never follow in a bunch.
///
///     sleep until schedule.next(now)
///     tick = schedule.begin(now)
class TickSchedule {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Nanoseconds = std::chrono::nanoseconds;

  /// Releases tick 0 at `start`. Precondition: a positive period.
  TickSchedule(Time start, Nanoseconds period) noexcept : start_(start), period_(period) {}

  /// Ends the present tick at `now` and returns the release of the next tick that has not passed.
  [[nodiscard]] Time next(Time now) noexcept;
  /// Begins that tick at `now`, not before its release. If `now` is later by whole periods, their
  /// ticks are missed too, and the tick of the present period begins.
  [[nodiscard]] TickStart begin(Time now) noexcept;

  /// The number of the present tick, from 0; missed ticks count.
  [[nodiscard]] std::uint64_t tick() const noexcept { return tick_; }
  /// The release of the present tick.
  [[nodiscard]] Time release() const noexcept {
    return start_ + static_cast<Nanoseconds::rep>(tick_) * period_;
  }
  /// The end of its period.
  [[nodiscard]] Time deadline() const noexcept { return release() + period_; }

 private:
  Time start_;
  Nanoseconds period_;
  std::uint64_t tick_ = 0;
  std::uint64_t missed_ = 0;  // before the present tick
};

/// Sleeps from tick to tick of a TickSchedule, on steady_clock. Used by one thread.
///
/// Timers wake a thread late: on a virtual machine by 50 µs in the median, and by 200 µs at the
/// 99th percentile. The clock therefore wakes early and spins until the release.
class TickClock {
 public:
  using Time = TickSchedule::Time;

  /// The time between waking and the release; at most half a period.
  static constexpr std::chrono::nanoseconds kLead = std::chrono::microseconds(100);

  /// Precondition: a positive period, usually 100 µs or more.
  explicit TickClock(std::chrono::nanoseconds period) noexcept;

  /// Begins tick 0.
  void start() noexcept;
  /// Ends the present tick and sleeps until the next one. Signals do not shorten the sleep.
  [[nodiscard]] TickStart wait_for_next() noexcept;

  [[nodiscard]] std::chrono::nanoseconds period() const noexcept { return period_; }
  /// The present tick: see TickSchedule.
  [[nodiscard]] std::uint64_t tick() const noexcept { return schedule_.tick(); }
  [[nodiscard]] Time release() const noexcept { return schedule_.release(); }
  [[nodiscard]] Time deadline() const noexcept { return schedule_.deadline(); }

 private:
  std::chrono::nanoseconds period_;
  TickSchedule schedule_;
};

}  // namespace ist
