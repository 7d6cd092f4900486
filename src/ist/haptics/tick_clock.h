#pragma once

#include <chrono>
#include <cstdint>

namespace ist {

/// How a tick began.
struct TickStart {
  std::chrono::nanoseconds late;  ///< from the time for which it was set to when it began: jitter
  std::uint64_t missed;           ///< whole ticks that were left out before it
};

/// At which times ticks begin: at a start and every period after it, whatever became of the ticks
/// before, so that no lateness adds up. A tick whose time has passed is left out: ticks that were
/// missed never follow in a bunch.
///
///     sleep until schedule.next(now)
///     tick = schedule.begin(now)
class TickSchedule {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Nanoseconds = std::chrono::nanoseconds;

  /// Tick 0 begins at `start`. Precondition: a positive period.
  TickSchedule(Time start, Nanoseconds period) noexcept : start_(start), period_(period) {}

  /// The present tick is over at `now`: when the next begins whose time has not passed.
  [[nodiscard]] Time next(Time now) noexcept;
  /// It begins, at `now`, not before that time. Where that is later by whole periods, they are
  /// missed too, and the present tick is the one within whose period it begins.
  [[nodiscard]] TickStart begin(Time now) noexcept;

  /// Of the present tick, by number: those that began and those that were missed, without tick 0.
  [[nodiscard]] std::uint64_t tick() const noexcept { return tick_; }
  /// When the present tick should have begun,
  [[nodiscard]] Time release() const noexcept {
    return start_ + static_cast<Nanoseconds::rep>(tick_) * period_;
  }
  /// and by when it must have ended.
  [[nodiscard]] Time deadline() const noexcept { return release() + period_; }

 private:
  Time start_;
  Nanoseconds period_;
  std::uint64_t tick_ = 0;
  std::uint64_t missed_ = 0;  // before the present tick
};

/// The beat of a loop: sleeps from tick to tick, as a TickSchedule says. Its times are those of
/// steady_clock. Not for several threads at once.
///
/// Timers wake a thread late, by 50 µs in the median on a virtual machine and by 200 at 99 of 100.
/// So it rises before the tick and waits for it awake, which takes up to that much of a core.
class TickClock {
 public:
  using Time = TickSchedule::Time;

  /// How long before a tick it rises; no more than half a period.
  static constexpr std::chrono::nanoseconds kLead = std::chrono::microseconds(100);

  /// Precondition: a positive period. (Loops of up to 10 kHz are meant: 100 µs.)
  explicit TickClock(std::chrono::nanoseconds period) noexcept;

  /// Tick 0 begins now.
  void start() noexcept;
  /// Ends the present tick and sleeps until the next one. Signals do not shorten the sleep.
  [[nodiscard]] TickStart wait_for_next() noexcept;

  [[nodiscard]] std::chrono::nanoseconds period() const noexcept { return period_; }
  /// Of the present tick: see TickSchedule.
  [[nodiscard]] std::uint64_t tick() const noexcept { return schedule_.tick(); }
  [[nodiscard]] Time release() const noexcept { return schedule_.release(); }
  [[nodiscard]] Time deadline() const noexcept { return schedule_.deadline(); }

 private:
  std::chrono::nanoseconds period_;
  TickSchedule schedule_;
};

}  // namespace ist
