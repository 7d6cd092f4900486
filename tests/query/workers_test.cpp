#include "ist/query/workers.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xmmintrin.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <numeric>
#include <thread>
#include <vector>

#include "ist/base/parallel.h"
#include "ist/query/chunk_board.h"

namespace ist {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// Until `done`, or for a minute: a machine that is busy is no failure.
bool eventually(const std::function<bool()>& done) {
  for (const auto give_up = Clock::now() + 60s; Clock::now() < give_up;) {
    if (done()) return true;
    std::this_thread::sleep_for(10us);
  }
  return false;
}

bool offered(ResidentWorker& worker, Job& job) {
  return eventually([&] {
    worker.tick(Clock::now(), 0ns);
    return worker.offer(job);
  });
}

// Adds one to a number that is not atomic: the job orders it.
struct Counting {
  static void run(void* context) noexcept { ++static_cast<Counting*>(context)->runs; }
  ~Counting() { job.wait_idle(); }
  int runs = 0;
  Job job{run, this};
};

// Stalls the worker wherever it comes to `point`, until it is destroyed.
class Stall {
 public:
  explicit Stall(HandOver point) {
    point_ = point;
    reached_ = released_ = false;
    hand_over_hook = [](HandOver at) noexcept {
      ++inside_;
      if (at == point_ && !released_) {
        reached_ = true;
        while (!released_) std::this_thread::sleep_for(100us);
      }
      --inside_;
    };
  }
  ~Stall() {
    hand_over_hook = nullptr;
    released_ = true;
    while (inside_ > 0) std::this_thread::sleep_for(100us);
  }
  Stall(const Stall&) = delete;
  Stall& operator=(const Stall&) = delete;

  [[nodiscard]] static bool reached() { return reached_; }

 private:
  static inline std::atomic<HandOver> point_;
  static inline std::atomic<bool> reached_, released_;
  static inline std::atomic<int> inside_{0};
};

TEST(ResidentWorkerThread, RunsWhatItIsOfferedAndWhatItWroteIsSeen) {
  ResidentWorker worker;
  Counting counting;
  for (int i = 1; i <= 200; ++i) {
    ASSERT_TRUE(offered(worker, counting.job));
    while (counting.job.busy()) _mm_pause();
    ASSERT_EQ(counting.runs, i);
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

// Sums squares with the worker's help, as a query divides a level.
struct Sum {
  static constexpr std::size_t kChunks = 64;

  static void help(void* context) noexcept {
    auto& sum = *static_cast<Sum*>(context);
    while (const auto chunk = sum.board.claim_back(sum.epoch)) {
      hand_over(HandOver::kClaimed);
      sum.parts[*chunk] = part(*chunk);
      hand_over(HandOver::kWorked);
      if (!sum.board.finish(sum.epoch, *chunk)) return;
    }
  }
  static std::uint64_t part(std::size_t chunk) { return chunk * chunk; }

  ~Sum() { job.wait_idle(); }

  // Returns the sum, done by the caller as far as the worker does not come.
  std::uint64_t with(ResidentWorker& worker) {
    if (job.busy()) return without();
    epoch = board.open(kChunks);
    const bool helped = worker.offer(job);
    std::array<std::uint64_t, kChunks> own{};
    while (const auto chunk = board.claim_front()) own[*chunk] = part(*chunk);
    for (std::size_t i = board.close(); i < kChunks; ++i)
      own[i] = board.take(i, 200us) ? parts[i] : part(i);
    if (helped) worker.retract(job);
    return std::accumulate(own.begin(), own.end(), std::uint64_t{0});
  }
  static std::uint64_t without() {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < kChunks; ++i) sum += part(i);
    return sum;
  }

  ChunkBoard board{kChunks};
  std::array<std::uint64_t, kChunks> parts{};
  std::uint64_t epoch = 0;
  Job job{help, this};
};

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

TEST(ResidentWorkerThread, ComesAndGoesWithItsHandles) {
  Counting counting;
  for (int i = 0; i < 30; ++i) {
    ResidentWorker worker;
    if (i % 3 == 0) {
      ASSERT_TRUE(offered(worker, counting.job)) << i;
    } else if (i % 3 == 1) {
      const ResidentWorker other;
    }
    counting.job.wait_idle();
  }
  EXPECT_EQ(counting.runs, 10);

  // Nothing of it runs now. (A task that TBB had not yet begun would leave as soon as it did.)
  std::this_thread::sleep_for(50ms);
  const ResidentWorker::Usage before = ResidentWorker::usage();
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(ResidentWorker::usage().wall, before.wall);
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
  EXPECT_TRUE(offered(worker, counting.job));
}

TEST(ResidentWorkerThread, HasAThreadWhereTbbIsLimitedToOne) {
  const ScopedThreadLimit limit(1);
  ResidentWorker worker;
  Counting counting;
  EXPECT_TRUE(offered(worker, counting.job));
}

TEST(ResidentWorkerThread, LeavesParallelLoopsTheirThreads) {
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
  EXPECT_GE(awake, 1);
  EXPECT_EQ(counting.runs, awake);
  EXPECT_GT(share, 0);
  EXPECT_LT(share, 0.9);
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

TEST(ResidentWorkerExit, AProcessEndsWithAHandleInAStatic) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto end = [] {
    static Counting counting;
    static ResidentWorker worker;
    std::exit(offered(worker, counting.job) ? 0 : 1);
  };
  EXPECT_EXIT(end(), testing::ExitedWithCode(0), "");
}

TEST(ResidentWorkerExit, AChildProcessHasNoWorkerAndDoesWithout) {
  auto worker = std::make_unique<ResidentWorker>();
  Sum sum;
  ASSERT_TRUE(offered(*worker, sum.job));
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
}  // namespace ist
