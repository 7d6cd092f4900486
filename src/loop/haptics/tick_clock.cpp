#include "loop/haptics/tick_clock.h"

#include <time.h>

#include <algorithm>
#include <cerrno>
#include <ratio>
#include <type_traits>

#include "ist/base/assert.h"
#include "ist/base/platform/pause.h"

namespace ist {
namespace {

using Clock = std::chrono::steady_clock;
// On Linux this is CLOCK_MONOTONIC, in nanoseconds since the same epoch.
static_assert(std::is_same_v<Clock::period, std::nano>);

// Returns at once if the time has passed.
void sleep_until(TickClock::Time time) noexcept {
  const auto ns = time.time_since_epoch().count();
  const timespec end{.tv_sec = static_cast<time_t>(ns / 1'000'000'000),
                     .tv_nsec = static_cast<long>(ns % 1'000'000'000)};
  int error;
  do {
    error = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &end, nullptr);
  } while (error == EINTR);
  IST_ASSERT(error == 0);
}

}  // namespace

TickSchedule::Time TickSchedule::next(Time now) noexcept {
  // A release at `now` itself is not missed.
  const Nanoseconds past = now - release() - Nanoseconds{1};
  missed_ = static_cast<std::uint64_t>(std::max(past, Nanoseconds{0}) / period_);
  tick_ += 1 + missed_;
  return release();
}

TickStart TickSchedule::begin(Time now) noexcept {
  const Nanoseconds late = now - release();
  IST_ASSERT(late >= Nanoseconds{0});
  const auto slept_through = static_cast<std::uint64_t>(late / period_);
  tick_ += slept_through;
  return {late, missed_ + slept_through};
}

TickClock::TickClock(std::chrono::nanoseconds period) noexcept
    : period_(period), schedule_(Clock::now(), period) {
  IST_ASSERT(period > std::chrono::nanoseconds{0});
}

void TickClock::start() noexcept { schedule_ = TickSchedule(Clock::now(), period_); }

TickStart TickClock::wait_for_next() noexcept {
  const Time next = schedule_.next(Clock::now());
  sleep_until(next - std::min(kLead, period_ / 2));
  Time now = Clock::now();
  for (; now < next; now = Clock::now()) pause_briefly();
  return schedule_.begin(now);
}

}  // namespace ist
