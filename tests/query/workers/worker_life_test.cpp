#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "ist/base/parallel.h"
#include "ist/query/workers/resident_worker.h"
#include "query/workers/worker_cases.h"
#include "support/effort.h"
#include "support/largest_allocation.h"
#include "support/system_calls.h"

namespace ist::test {
namespace {

TEST(ResidentWorkerThread, ComesAndGoesWithItsHandles) {
  Counting counting;
  for (int i = 0; i < 30; ++i) {
    ResidentWorker worker;
    if (i % 3 == 0) {
      offer_until_taken(worker, counting.job);
    } else if (i % 3 == 1) {
      const ResidentWorker other;
    }
    counting.job.wait_idle();
  }
  EXPECT_EQ(counting.runs, 10);

  // It leaves then. (A task that TBB begins late leaves at once.)
  wait_until([] { return !ResidentWorker::is_there(); });
}

TEST(ResidentWorkerThread, ComesAndGoesFromManyThreads) {
  std::vector<std::jthread> owners;
  for (int owner = 0; owner < 4; ++owner) {
    owners.emplace_back([] {
      for (int i = 0; i < 50; ++i) const ResidentWorker worker;
    });
  }
  owners.clear();
  ResidentWorker worker;
  Counting counting;
  offer_until_taken(worker, counting.job);
  counting.job.wait_idle();
  EXPECT_EQ(counting.runs, 1);
}

TEST(ResidentWorkerThread, HasAThreadWhereTbbIsLimitedToOne) {
  const ScopedThreadLimit limit(1);
  ResidentWorker worker;
  Counting counting;
  offer_until_taken(worker, counting.job);
  counting.job.wait_idle();
  EXPECT_EQ(counting.runs, 1);
}

TEST(ResidentWorkerThread, ParallelLoopsEndBesideIt) {
  ResidentWorker worker;
  Sum sum;
  for (const std::size_t threads : {std::size_t{1}, std::size_t{2}, std::size_t{7}}) {
    const ScopedThreadLimit limit(threads);
    for (int i = 0; i < 20; ++i) {
      std::atomic<int> done{0};
      parallel_for(100, 1, [&](std::size_t, std::size_t) { ++done; });
      EXPECT_EQ(done, 100);
      worker.tick(Clock::now(), 0ns);
      EXPECT_EQ(sum.with(worker), Sum::without());
    }
  }
}

// Returns when two ranges of a parallel loop have met. Each waits for the other, so a loop of one
// thread never ends.
int two_threads_meet() {
  std::atomic<int> here{0};
  parallel_for(2, 1, [&](std::size_t, std::size_t) {
    ++here;
    while (here < 2) std::this_thread::yield();
  });
  return here;
}

TEST(ResidentWorkerThread, LeavesParallelLoopsTheirThreads) {
  if (thread_count() < 2) IST_SKIP("this process has one core: there is none to leave");
  EXPECT_EQ(two_threads_meet(), 2);
  ResidentWorker worker;
  Counting counting;
  offer_until_taken(worker, counting.job);  // it has its thread
  EXPECT_EQ(two_threads_meet(), 2);
}

// All that a query does with the worker, until it has helped twenty times.
bool right_all_the_time(ResidentWorker& worker, Sum& sum) {
  bool right = true;
  for (int i = 0, helped = 0; helped < 20; ++i) {
    worker.tick(Clock::now(), 0ns);
    const std::uint64_t made = i % 2 == 0 ? sum.with_help(worker) : sum.with(worker);
    right = right && made == Sum::without();
    helped += sum.helped;
  }
  return right;
}

TEST(ResidentWorkerCaller, AllocatesNothing) {
  ResidentWorker worker;
  Sum sum;
  offer_until_taken(worker, sum.job);
  bool right = false;
  EXPECT_EQ(largest_allocation([&] { right = right_all_the_time(worker, sum); }), 0u);
  EXPECT_TRUE(right);
}

TEST(ResidentWorkerCaller, MakesNoSystemCall) {
  if (kSanitized) GTEST_SKIP() << "sanitizers call the system themselves";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto play = [](bool call) {
    ResidentWorker worker;
    Sum sum;
    offer_until_taken(worker, sum.job);
    forbid_system_calls();
    const bool right = right_all_the_time(worker, sum);
    if (call) std::this_thread::sleep_for(1us);
    end_process(right ? 0 : 1);
  };
  EXPECT_EXIT(play(false), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(play(true), testing::KilledBySignal(SIGSYS), "");  // it would have been noticed
}

TEST(ResidentWorkerExit, AProcessEndsWithAHandleInAStatic) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto end = [] {
    static Counting counting;
    static ResidentWorker worker;
    offer_until_taken(worker, counting.job);
    std::exit(0);
  };
  EXPECT_EXIT(end(), testing::ExitedWithCode(0), "");
}

TEST(ResidentWorkerExit, AProcessEndsWithAHandleThatIsNeverDestroyed) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto end = [] {
    static Counting counting;
    static const auto* const kept = new ResidentWorker;
    ResidentWorker worker;
    offer_until_taken(worker, counting.job);
    std::exit(kept != nullptr ? 0 : 1);
  };
  EXPECT_EXIT(end(), testing::ExitedWithCode(0), "");
}

TEST(ResidentWorkerExit, AChildProcessHasNoWorkerAndDoesWithout) {
  auto worker = std::make_unique<ResidentWorker>();
  Sum sum;
  offer_until_taken(*worker, sum.job);
  sum.job.wait_idle();
  const pid_t child = fork();
  if (child == 0) {
    bool right = true;
    for (int i = 0; i < 100; ++i) {
      worker->tick(Clock::now(), 0ns);
      right = right && sum.with(*worker) == Sum::without() && !sum.job.busy();
    }
    worker.reset();
    _exit(right ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

}  // namespace
}  // namespace ist::test
