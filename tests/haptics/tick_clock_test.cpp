#include "loop/haptics/tick_clock.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>
#include <time.h>

#include <atomic>
#include <thread>

#include "support/random.h"

namespace ist::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Nanoseconds = std::chrono::nanoseconds;

const TickSchedule::Time kStart{1000h};

TEST(TickSchedule, BeginsATickEveryPeriodWhateverItsLateness) {
  TickSchedule schedule(kStart, 1ms);
  EXPECT_EQ(schedule.tick(), 0u);
  EXPECT_EQ(schedule.release(), kStart);
  EXPECT_EQ(schedule.deadline(), kStart + 1ms);
  for (int i = 1; i <= 100; ++i) {
    EXPECT_EQ(schedule.next(kStart + (i - 1) * 1ms + 900us), kStart + i * 1ms);
    const TickStart tick = schedule.begin(kStart + i * 1ms + i * 5us);
    EXPECT_EQ(tick.late, i * 5us);
    EXPECT_EQ(tick.missed, 0u);
    EXPECT_EQ(schedule.tick(), static_cast<std::uint64_t>(i));
    EXPECT_EQ(schedule.deadline(), kStart + (i + 1) * 1ms);
  }
}

TEST(TickSchedule, LeavesOutTheTicksThatWorkRanOver) {
  const auto after = [](Nanoseconds work) {
    TickSchedule schedule(kStart, 1ms);
    const auto next = schedule.next(kStart + work);
    EXPECT_EQ(next, schedule.release());
    const TickStart tick = schedule.begin(next);
    EXPECT_EQ(tick.late, 0ns);
    EXPECT_EQ(schedule.tick(), tick.missed + 1);
    EXPECT_EQ(next, kStart + static_cast<int>(tick.missed + 1) * 1ms);
    return tick.missed;
  };
  EXPECT_EQ(after(0ms), 0u);
  EXPECT_EQ(after(1ms - 1ns), 0u);
  EXPECT_EQ(after(1ms), 0u);  // it begins right now
  EXPECT_EQ(after(1ms + 1ns), 1u);
  EXPECT_EQ(after(2ms), 1u);
  EXPECT_EQ(after(2ms + 1ns), 2u);
  EXPECT_EQ(after(1h), 3599999u);
}

TEST(TickSchedule, LeavesOutTheTicksThatWereSleptThrough) {
  TickSchedule schedule(kStart, 1ms);
  ASSERT_EQ(schedule.next(kStart + 2ms + 500us), kStart + 3ms);
  const TickStart tick = schedule.begin(kStart + 5ms + 250us);
  EXPECT_EQ(tick.late, 2ms + 250us);
  EXPECT_EQ(tick.missed, 2u + 2u);  // worked over 1 and 2, slept through 3 and 4
  EXPECT_EQ(schedule.tick(), 5u);
  EXPECT_EQ(schedule.deadline(), kStart + 6ms);
  ASSERT_EQ(schedule.next(kStart + 5ms + 300us), kStart + 6ms);
  EXPECT_EQ(schedule.begin(kStart + 6ms).missed, 0u);
}

TEST(TickSchedule, CountsEachTickOnceAsBegunOrMissed) {
  Random random(4);
  for (const Nanoseconds period : {1ns, 100000ns, 333333ns, 1000000ns}) {
    TickSchedule schedule(kStart, period);
    TickSchedule::Time now = kStart;
    const auto some = [&](double most) {
      const double periods = most * random.uniform(0, 1) * random.uniform(0, 1);
      return Nanoseconds(static_cast<std::int64_t>(periods * static_cast<double>(period.count())));
    };
    std::uint64_t begun = 0, missed = 0;
    for (int i = 0; i < 10000; ++i) {
      const auto worked = now + some(3);
      const auto next = schedule.next(worked);
      ASSERT_GE(next, worked);
      ASSERT_LE(next - worked, period);
      now = next + some(2.5);
      const TickStart tick = schedule.begin(now);
      ASSERT_EQ(tick.late, now - next);
      missed += tick.missed;
      ++begun;
      ASSERT_EQ(begun + missed, static_cast<std::uint64_t>((now - kStart) / period));
      ASSERT_EQ(schedule.tick(), begun + missed);
      ASSERT_LE(schedule.release(), now);
      ASSERT_GT(schedule.deadline(), now);
    }
  }
}

TEST(TickClock, TellsTheTimeOfTheSteadyClock) {
  const auto monotonic = [] {
    timespec time{};
    EXPECT_EQ(clock_gettime(CLOCK_MONOTONIC, &time), 0);
    return Clock::time_point(std::chrono::seconds(time.tv_sec) + Nanoseconds(time.tv_nsec));
  };
  const auto before = monotonic(), between = Clock::now(), after = monotonic();
  EXPECT_LE(before, between);
  EXPECT_LE(between, after);
}

TEST(TickClock, BeginsNoTickBeforeItsTimeAndAccountsForAll) {
  for (const Nanoseconds period : {100us, 1000us}) {
    TickClock clock(period);
    const auto before = Clock::now();
    clock.start();
    const auto start = clock.release();
    EXPECT_GE(start, before);
    EXPECT_LE(start, Clock::now());
    std::uint64_t begun = 0, missed = 0;
    auto last = start;
    for (int i = 0; i < 50; ++i) {
      const TickStart tick = clock.wait_for_next();
      const auto now = Clock::now();
      ++begun;
      missed += tick.missed;
      ASSERT_GE(tick.late, 0ns);
      ASSERT_GT(clock.release(), last);
      ASSERT_LE(clock.release(), now);
      ASSERT_EQ(clock.tick(), begun + missed);
      ASSERT_EQ(clock.release(), start + static_cast<int>(begun + missed) * period);
      ASSERT_EQ(clock.deadline(), clock.release() + period);
      last = clock.release();
    }
  }
}

TEST(TickClock, GoesOnInTheFutureAfterAnOversleep) {
  TickClock clock(2ms);
  clock.start();
  std::this_thread::sleep_for(11ms);
  const auto late = Clock::now();
  const TickStart tick = clock.wait_for_next();
  EXPECT_GE(tick.missed, 5u);
  EXPECT_EQ(clock.tick(), 1 + tick.missed);
  EXPECT_GT(clock.release(), late);
  EXPECT_LE(clock.release(), Clock::now());
  const auto begun = clock.release();
  static_cast<void>(clock.wait_for_next());
  EXPECT_GE(clock.release(), begun + 2ms);
}

TEST(TickClock, BeginsAgainWhenStartedAgain) {
  TickClock clock(1ms);
  clock.start();
  static_cast<void>(clock.wait_for_next());
  clock.start();
  EXPECT_EQ(clock.tick(), 0u);
  EXPECT_LE(clock.release(), Clock::now());
}

// When the first signal came since this was 0, by the steady clock.
std::atomic<Nanoseconds::rep> signal_time{0};
static_assert(std::atomic<Nanoseconds::rep>::is_always_lock_free);

void note_signal(int) {
  Nanoseconds::rep none = 0;
  signal_time.compare_exchange_strong(none, Clock::now().time_since_epoch().count());
}

TEST(TickClockThread, SignalsDoNotShortenTheSleep) {
  struct sigaction action {
  }, before{};
  action.sa_handler = note_signal;
  ASSERT_EQ(sigaction(SIGUSR1, &action, &before), 0);
  const pthread_t sleeper = pthread_self();
  std::jthread sender([sleeper](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      std::this_thread::sleep_for(1ms);
      pthread_kill(sleeper, SIGUSR1);
    }
  });
  TickClock clock(20ms);
  clock.start();
  // However late the signals are, five of them come while the clock sleeps.
  for (int disturbed = 0; disturbed < 5;) {
    signal_time = 0;
    const auto begun = Clock::now();
    EXPECT_GE(clock.wait_for_next().late, 0ns);
    EXPECT_GE(Clock::now(), clock.release());
    const Clock::time_point came{Nanoseconds(signal_time)};
    if (came > begun && came < clock.release() - 1ms) ++disturbed;
  }
  sender.request_stop();
  sender.join();
  ASSERT_EQ(sigaction(SIGUSR1, &before, nullptr), 0);
}

}  // namespace
}  // namespace ist::test
