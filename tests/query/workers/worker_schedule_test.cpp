#include "ist/query/workers/worker_schedule.h"

#include <gtest/gtest.h>

namespace ist::worker_schedule {
namespace {

using namespace std::chrono_literals;

const Clock::time_point kTick = Clock::time_point{} + 1h;

// How long the worker sleeps, at a time after a tick that it noticed at once.
Nanoseconds sleep_at(Nanoseconds since_tick, Nanoseconds period, Nanoseconds since_sign) {
  const Clock::time_point now = kTick + since_tick;
  return next_look(now, kTick, now - since_sign, period) - now;
}
Nanoseconds sleep_at(Nanoseconds since_tick, Nanoseconds period) {
  return sleep_at(since_tick, period, since_tick);
}

TEST(WorkerSchedule, PollsAfterATickAndThenSleepsUntilJustBeforeTheNext) {
  EXPECT_EQ(sleep_at(0ms, 1ms), 0ns);
  EXPECT_EQ(sleep_at(kLinger - 1ns, 1ms), 0ns);
  EXPECT_EQ(sleep_at(kLinger, 1ms), 1ms - kLinger - kLead);
  EXPECT_EQ(sleep_at(600us, 1ms, 10us), 0ns);  // the tick's work has just ended
  EXPECT_EQ(sleep_at(1ms - kLead - 1ns, 1ms), 1ns);
  EXPECT_EQ(sleep_at(1ms - kLead, 1ms), 0ns);
}

TEST(WorkerSchedule, WaitsForALateTickAndThenForTheOneAfter) {
  EXPECT_EQ(sleep_at(1ms, 1ms), 0ns);
  EXPECT_EQ(sleep_at(1ms + kLate - 1ns, 1ms), 0ns);
  EXPECT_EQ(sleep_at(1ms + kLate, 1ms), 1ms - kLate - kLead);
  EXPECT_EQ(sleep_at(42ms + kLate, 1ms), 1ms - kLate - kLead);
}

TEST(WorkerSchedule, NapsLongWhenNoTickHasComeForLong) {
  EXPECT_EQ(sleep_at(101ms, 1ms), kLongNap);
  EXPECT_EQ(sleep_at(101ms, 0ms), kLongNap);
  EXPECT_LT(sleep_at(101ms, 2ms), 2ms);  // a hundred periods are more
  EXPECT_EQ(sleep_at(201ms, 2ms), kLongNap);
}

TEST(WorkerSchedule, PollsBetweenTicksThatFollowBackToBack) {
  EXPECT_EQ(sleep_at(0us, 0us), 0ns);
  EXPECT_EQ(sleep_at(kLingerBackToBack - 1ns, 0us), 0ns);
  EXPECT_EQ(sleep_at(kLingerBackToBack, 0us), kNap);
  EXPECT_EQ(sleep_at(50ms, 0us), kNap);
}

TEST(WorkerSchedule, NapsAreBoundedWhateverIsReported) {
  for (const Nanoseconds period :
       {Nanoseconds::min(), Nanoseconds{-1}, Nanoseconds{1}, Nanoseconds{1h}, Nanoseconds::max()}) {
    for (const Nanoseconds since_tick : {Nanoseconds{-1h}, Nanoseconds{-1}, Nanoseconds{1h}}) {
      const Nanoseconds sleep = sleep_at(since_tick, period, 1ms);
      EXPECT_GE(sleep, 0ns);
      EXPECT_LE(sleep, kLongNap);
      EXPECT_EQ(sleep_at(since_tick, period, 200s), kLongNap);  // silent: it sleeps, in any case
    }
  }
}

}  // namespace
}  // namespace ist::worker_schedule
