#include "ist/query/workers/resident_worker.h"

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <iostream>
#include <thread>
#include <vector>

#include "ist/query/workers/worker_schedule.h"
#include "query/workers/stall.h"
#include "query/workers/worker_cases.h"

namespace ist::test {
namespace {

TEST(ResidentWorkerThread, RunsWhatItIsOfferedAndWhatItWroteIsSeen) {
  ResidentWorker worker;
  Counting counting;
  for (int i = 1; i <= 200; ++i) {
    offer_until_taken(worker, counting.job);
    wait_spinning(counting.job);
    ASSERT_EQ(counting.runs, i);
  }
}

// The schedule lets it never sleep. A job is offered only after it has looked for work since the
// last one: it reports its time between two looks, each millisecond. So nothing excuses a refusal,
// not even a core that it loses.
TEST(ResidentWorkerThread, AcceptsEveryOfferWhileItIsAwake) {
  const Awake awake;
  ResidentWorker worker;
  Counting counting;
  offer_until_taken(worker, counting.job);  // it is there
  counting.job.wait_idle();
  for (int job = 2; job <= 1000; ++job) {
    const auto reported = ResidentWorker::usage().wall;
    wait_until([&] { return ResidentWorker::usage().wall != reported; });
    ASSERT_TRUE(worker.offer(counting.job)) << "job " << job;
    counting.job.wait_idle();
    ASSERT_EQ(counting.runs, job);
  }
}

TEST(ResidentWorkerThread, RefusesAnOfferWhileItIsAtWork) {
  ResidentWorker worker;
  Counting first, second;
  const Stall stall(HandOver::kEntered);
  offer_until_taken(worker, first.job);
  EXPECT_TRUE(first.job.busy());
  EXPECT_FALSE(worker.offer(second.job));
  EXPECT_FALSE(second.job.busy());
  EXPECT_FALSE(worker.offer(first.job));
  wait_until(Stall::reached);
  EXPECT_FALSE(worker.offer(second.job));
  EXPECT_FALSE(worker.offer(first.job));
}

// Returns when the worker has refused the job. Nobody ticks meanwhile, so it goes to sleep.
void offer_until_refused(ResidentWorker& worker, Job& job) {
  wait_until([&] {
    std::this_thread::sleep_for(5ms);
    const bool refused = !worker.offer(job);
    job.wait_idle();
    return refused;
  });
}

TEST(ResidentWorkerThread, RefusesAnOfferWhileItSleepsAndRisesAgain) {
  ResidentWorker worker;
  Counting counting;
  for (int round = 0; round < 3; ++round) {
    offer_until_taken(worker, counting.job);
    counting.job.wait_idle();
    offer_until_refused(worker, counting.job);
  }
}

TEST(ResidentWorkerThread, AJobIsRetractedUntilItIsEntered) {
  ResidentWorker worker;
  Counting counting;
  EXPECT_FALSE(worker.retract(counting.job));
  {
    const Stall stall(HandOver::kSeen);
    offer_until_taken(worker, counting.job);
    wait_until(Stall::reached);
    EXPECT_TRUE(worker.retract(counting.job));
    EXPECT_FALSE(counting.job.busy());
  }
  {
    const Stall stall(HandOver::kEntered);
    offer_until_taken(worker, counting.job);
    wait_until(Stall::reached);
    EXPECT_FALSE(worker.retract(counting.job));
    EXPECT_TRUE(counting.job.busy());
  }
  counting.job.wait_idle();
  EXPECT_EQ(counting.runs, 1);
}

TEST(ResidentWorkerThread, RetractingAndEnteringHaveOneWinner) {
  ResidentWorker worker;
  Counting counting;
  int expected = 0, retracted = 0;
  for (int i = 0; i < 2000 || retracted == 0 || expected == 0; ++i) {
    offer_until_taken(worker, counting.job);
    for (int pause = 0; pause < i % 16; ++pause) _mm_pause();
    // On one core the worker may need a while to enter.
    if (i >= 2000 && expected == 0) std::this_thread::sleep_for(1ms);
    if (worker.retract(counting.job)) {
      ++retracted;
    } else {
      ++expected;
      wait_spinning(counting.job);
    }
    ASSERT_EQ(counting.runs, expected);
  }
  std::cout << "retracted: " << retracted << ", entered: " << expected << '\n';
}

TEST(ResidentWorkerThread, TheOwnerCompletesWhereverTheWorkerStalls) {
  ResidentWorker worker;
  for (const HandOver point :
       {HandOver::kSeen, HandOver::kEntered, HandOver::kClaimed, HandOver::kWorked}) {
    Sum sum;
    {
      const Stall stall(point);
      // The owner leaves its chunks until the worker stalls.
      wait_until([&] {
        worker.tick(Clock::now(), 0ns);
        EXPECT_EQ(sum.with(worker, [] { wait_until(Stall::reached); }), Sum::without());
        return Stall::reached();
      });
      for (int i = 0; i < 20; ++i) {
        worker.tick(Clock::now(), 0ns);
        EXPECT_EQ(sum.with(worker), Sum::without());
      }
    }
    for (int i = 0; i < 20; ++i) EXPECT_EQ(sum.with(worker), Sum::without());
  }
}

TEST(ResidentWorkerThread, ServesSeveralOwnersAtOnce) {
  std::vector<std::jthread> owners;
  for (int owner = 0; owner < 4; ++owner) {
    owners.emplace_back([] {
      ResidentWorker worker;
      Sum sum;
      for (int i = 0, helped = 0; i < 500 || helped < 5; ++i) {
        worker.tick(Clock::now(), 0ns);
        // Now and then the owner waits for the worker, if that has taken its offer.
        const auto meet = [&] {
          if (i % 20 == 0) wait_until([&] { return sum.entered.load(); });
        };
        ASSERT_EQ(sum.with(worker, meet), Sum::without());
        helped += sum.helped;
      }
    });
  }
}

TEST(ResidentWorkerThread, RunsJobsWithIeeeArithmetic) {
  struct Register {
    static void run(void* context) noexcept {
      static_cast<Register*>(context)->seen = _mm_getcsr();
      _mm_setcsr(0x9FC0);  // flushes to zero: the next job must not
    }
    unsigned seen = 0;
  };
  ResidentWorker worker;
  for (int i = 0; i < 2; ++i) {
    Register reg;
    Job job(Register::run, &reg);
    offer_until_taken(worker, job);
    job.wait_idle();
    EXPECT_EQ(reg.seen, 0x1F80u);
  }
}

// How often it is found, and which share of a core it takes, is bench/query_bench's matter.
TEST(ResidentWorkerThread, IsAwakeForTicksWithAPeriodAndSleepsBetween) {
  ResidentWorker worker;
  Counting counting;
  offer_until_taken(worker, counting.job);  // it is there
  counting.job.wait_idle();
  int ticks = 0, at_ticks = 0, between = 0, asleep = 0;
  Clock::time_point next = Clock::now();
  while (ticks < 200 || at_ticks < 5 || asleep < 20) {
    ++ticks;
    next = std::max(next + 1ms, Clock::now());
    std::this_thread::sleep_until(next);
    worker.tick(Clock::now(), 1ms);
    if (worker.offer(counting.job)) ++at_ticks;
    counting.job.wait_idle();
    std::this_thread::sleep_until(next + 500us);
    ++(worker.offer(counting.job) ? between : asleep);
    counting.job.wait_idle();
  }
  EXPECT_EQ(counting.runs, 1 + at_ticks + between);
  std::cout << "awake at " << at_ticks << " of " << ticks << " ticks, and asleep after " << asleep
            << '\n';
}

TEST(ResidentWorkerThread, IsFoundInLongTicksThatFollowBackToBack) {
  ResidentWorker worker;
  Counting counting;
  offer_until_taken(worker, counting.job);  // it is there
  counting.job.wait_idle();
  offer_until_refused(worker, counting.job);  // it naps
  const int runs = counting.runs;
  bool found = false;
  while (!found) {
    worker.tick(Clock::now(), 0ns);
    for (const auto end = Clock::now() + 3ms; !found && Clock::now() < end;)
      found = worker.offer(counting.job);
  }
  counting.job.wait_idle();
  EXPECT_EQ(counting.runs, runs + 1);
}

// It forgets the last tick. Then all its naps are long, and no offer finds it.
TEST(ResidentWorkerThread, UsesLittleWhenNobodyTicks) {
  ResidentWorker worker;
  Counting counting;
  offer_until_taken(worker, counting.job);  // it is there
  counting.job.wait_idle();
  const ResidentWorker::Usage before = ResidentWorker::usage();
  auto last = before.wall, now = last;
  for (int long_naps = 0; long_naps < 10; last = now) {  // it reports its time before each nap
    wait_until([&] { return (now = ResidentWorker::usage().wall) != last; });
    long_naps = now - last >= worker_schedule::kLongNap ? long_naps + 1 : 0;
  }
  EXPECT_FALSE(worker.offer(counting.job));
  EXPECT_EQ(counting.runs, 1);
  const ResidentWorker::Usage after = ResidentWorker::usage();
  std::cout << 100 * std::chrono::duration<double>(after.cpu - before.cpu) /
                   std::chrono::duration<double>(after.wall - before.wall)
            << " % of a core\n";
}

}  // namespace
}  // namespace ist::test
