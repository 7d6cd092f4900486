#include "ist/query/workers/resident_worker.h"

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <iostream>
#include <thread>
#include <vector>

#include "query/workers/stall.h"
#include "query/workers/worker_cases.h"

namespace ist::test {
namespace {

TEST(ResidentWorkerThread, RunsWhatItIsOfferedAndWhatItWroteIsSeen) {
  ResidentWorker worker;
  Counting counting;
  for (int i = 1; i <= 200; ++i) {
    ASSERT_TRUE(offered(worker, counting.job));
    while (counting.job.busy()) _mm_pause();
    ASSERT_EQ(counting.runs, i);
  }
}

// By a schedule on which it never sleeps, and offered only where it has looked for work since the
// last job: it reports its time between two such looks, each millisecond. So nothing, not even a
// core that it loses, excuses a refusal.
TEST(ResidentWorkerThread, AcceptsEveryOfferWhileItIsAwake) {
  const Awake awake;
  ResidentWorker worker;
  Counting counting;
  ASSERT_TRUE(offered(worker, counting.job));  // it is there
  counting.job.wait_idle();
  for (int job = 2; job <= 1000; ++job) {
    const auto reported = ResidentWorker::usage().wall;
    ASSERT_TRUE(eventually([&] { return ResidentWorker::usage().wall != reported; }));
    ASSERT_TRUE(worker.offer(counting.job)) << "job " << job;
    counting.job.wait_idle();
    ASSERT_EQ(counting.runs, job);
  }
}

TEST(ResidentWorkerThread, RefusesAnOfferWhileItIsAtWork) {
  ResidentWorker worker;
  Counting first, second;
  const Stall stall(HandOver::kEntered);
  ASSERT_TRUE(offered(worker, first.job));
  EXPECT_TRUE(first.job.busy());
  EXPECT_FALSE(worker.offer(second.job));
  EXPECT_FALSE(second.job.busy());
  EXPECT_FALSE(worker.offer(first.job));
  EXPECT_TRUE(eventually(Stall::reached));
  EXPECT_FALSE(worker.offer(second.job));
  EXPECT_FALSE(worker.offer(first.job));
}

TEST(ResidentWorkerThread, RefusesAnOfferWhileItSleepsAndRisesAgain) {
  ResidentWorker worker;
  Counting counting;
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(offered(worker, counting.job));
    counting.job.wait_idle();
    EXPECT_TRUE(eventually([&] {  // nobody ticks
      std::this_thread::sleep_for(5ms);
      const bool refused = !worker.offer(counting.job);
      counting.job.wait_idle();
      return refused;
    }));
  }
}

TEST(ResidentWorkerThread, AJobIsRetractedUntilItIsEntered) {
  ResidentWorker worker;
  Counting counting;
  EXPECT_FALSE(worker.retract(counting.job));
  {
    const Stall stall(HandOver::kSeen);
    ASSERT_TRUE(offered(worker, counting.job));
    ASSERT_TRUE(eventually(Stall::reached));
    EXPECT_TRUE(worker.retract(counting.job));
    EXPECT_FALSE(counting.job.busy());
  }
  {
    const Stall stall(HandOver::kEntered);
    ASSERT_TRUE(offered(worker, counting.job));
    ASSERT_TRUE(eventually(Stall::reached));
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
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(offered(worker, counting.job));
    for (int pause = 0; pause < i % 16; ++pause) _mm_pause();
    if (worker.retract(counting.job)) {
      ++retracted;
    } else {
      ++expected;
      while (counting.job.busy()) _mm_pause();
    }
    ASSERT_EQ(counting.runs, expected);
  }
  std::cout << "retracted: " << retracted << " of 2000\n";
}

TEST(ResidentWorkerThread, TheOwnerCompletesWhereverTheWorkerStalls) {
  ResidentWorker worker;
  for (const HandOver point :
       {HandOver::kSeen, HandOver::kEntered, HandOver::kClaimed, HandOver::kWorked}) {
    Sum sum;
    {
      const Stall stall(point);
      EXPECT_TRUE(eventually([&] {
        worker.tick(Clock::now(), 0ns);
        EXPECT_EQ(sum.with(worker), Sum::without());
        return Stall::reached();
      })) << "no stall at "
          << static_cast<int>(point);
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
      for (int i = 0; i < 500; ++i) {
        worker.tick(Clock::now(), 0ns);
        ASSERT_EQ(sum.with(worker), Sum::without());
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
    ASSERT_TRUE(offered(worker, job));
    job.wait_idle();
    EXPECT_EQ(reg.seen, 0x1F80u);
  }
}

TEST(ResidentWorkerThread, IsAwakeForTicksWithAPeriodAndSleepsBetween) {
  ResidentWorker worker;
  Counting counting;
  constexpr int kTicks = 1000;
  int awake = 0;
  const ResidentWorker::Usage before = ResidentWorker::usage();
  Clock::time_point next = Clock::now();
  for (int i = 0; i < kTicks; ++i) {
    next = std::max(next + 1ms, Clock::now());
    std::this_thread::sleep_until(next);
    worker.tick(Clock::now(), 1ms);
    if (worker.offer(counting.job)) ++awake;
    for (const auto end = Clock::now() + 50us; Clock::now() < end;) _mm_pause();
    while (counting.job.busy()) _mm_pause();
  }
  const ResidentWorker::Usage after = ResidentWorker::usage();
  const double share = std::chrono::duration<double>(after.cpu - before.cpu) /
                       std::chrono::duration<double>(after.wall - before.wall);
  std::cout << "awake in " << awake << " of " << kTicks << " ticks, " << 100 * share
            << " % of a core\n";
  EXPECT_EQ(counting.runs, awake);
  EXPECT_GT(share, 0);
  EXPECT_LT(share, 0.9);
}

TEST(ResidentWorkerThread, IsFoundInLongTicksThatFollowBackToBack) {
  ResidentWorker worker;
  std::this_thread::sleep_for(150ms);  // it naps
  Counting counting;
  EXPECT_TRUE(eventually([&] {
    worker.tick(Clock::now(), 0ns);
    bool found = false;
    for (const auto end = Clock::now() + 3ms; !found && Clock::now() < end;)
      found = worker.offer(counting.job);
    return found;
  }));
}

TEST(ResidentWorkerThread, UsesLittleWhenNobodyTicks) {
  ResidentWorker worker;
  std::this_thread::sleep_for(300ms);  // the last tick is forgotten
  const ResidentWorker::Usage before = ResidentWorker::usage();
  std::this_thread::sleep_for(500ms);
  const ResidentWorker::Usage after = ResidentWorker::usage();
  const auto wall = after.wall - before.wall, cpu = after.cpu - before.cpu;
  std::cout << 100 * std::chrono::duration<double>(cpu) / std::chrono::duration<double>(wall)
            << " % of a core\n";
  EXPECT_LT(cpu, wall / 4);
}

}  // namespace
}  // namespace ist::test
