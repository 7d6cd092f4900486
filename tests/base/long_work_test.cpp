#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <vector>

#include "ist/base/cancellation.h"
#include "ist/base/parallel.h"
#include "ist/base/progress.h"
#include "support/errors.h"
#include "support/random.h"

namespace ist {
namespace {

TEST(ParallelFor, CoversEachItemOnceInRangesThatDoNotDependOnTheThreads) {
  for (const std::size_t threads : {1u, 2u, 7u}) {
    const ScopedThreadLimit limit(threads);
    for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 1000u}) {
      std::vector<int> visits(count), range_begin(count, -1);
      parallel_for(count, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          ++visits[i];
          range_begin[i] = static_cast<int>(begin);
        }
      });
      EXPECT_EQ(visits, std::vector<int>(count, 1));
      for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(range_begin[i], i / 64 * 64);
    }
  }
}

TEST(ParallelSort, SortsAnyLength) {
  for (const std::size_t count : {0u, 1u, 2u, 16383u, 16384u, 16385u, 100000u, 1000003u}) {
    std::vector<std::uint64_t> keys(count);
    test::Random random(count);
    for (std::uint64_t& key : keys) key = random.bits();
    std::vector<std::uint64_t> expected = keys;
    std::sort(expected.begin(), expected.end());
    parallel_sort(keys);
    EXPECT_EQ(keys, expected);
  }
}

// Else a range that holds a lock would wait for itself.
TEST(ParallelFor, AThreadThatWaitsForItsLoopTakesNoRangeOfAnOuterOne) {
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::atomic<int> nested{0};
    parallel_for(64, 1, [&](std::size_t, std::size_t) {
      thread_local bool waits = false;
      nested += waits;
      waits = true;
      std::atomic<int> work{0};
      parallel_for(16, 1, [&](std::size_t, std::size_t) {
        for (int i = 0; i < 500; ++i) ++work;
      });
      waits = false;
    });
    EXPECT_EQ(nested, 0);
  }
}

TEST(ParallelFor, AnExceptionReachesTheCaller) {
  EXPECT_THROW(parallel_for(100, 1,
                            [](std::size_t begin, std::size_t) {
                              if (begin == 57) throw std::runtime_error("57");
                            }),
               std::runtime_error);
}

TEST(ParallelFor, RunsWithIeeeArithmeticAndRestoresTheCallers) {
  constexpr unsigned kFlushToZero = 0x8000, kRoundUp = 0x4000, kDefault = 0x1F80;
  std::vector<unsigned> seen(64);
  unsigned after = 0;
  // A new thread, because TBB keeps the arithmetic of the first call on a thread.
  std::thread([&] {
    _mm_setcsr(kDefault | kFlushToZero | kRoundUp);
    parallel_for(64, 1, [&](std::size_t begin, std::size_t) { seen[begin] = _mm_getcsr(); });
    after = _mm_getcsr();
  }).join();
  EXPECT_EQ(seen, std::vector<unsigned>(64, kDefault));
  EXPECT_EQ(after & (kFlushToZero | kRoundUp), kFlushToZero | kRoundUp);
}

TEST(Progress, BeginsWithNothingDone) {
  const Progress progress;
  EXPECT_STREQ(progress.stage(), "");
  EXPECT_EQ(progress.fraction(), 0.0);
}

TEST(Progress, CountsWhatAllThreadsAdd) {
  Progress progress;
  progress.begin_stage("counting", 4000);
  parallel_for(1000, 7, [&](std::size_t begin, std::size_t end) { progress.add(end - begin); });
  EXPECT_STREQ(progress.stage(), "counting");
  EXPECT_EQ(progress.fraction(), 0.25);
}

TEST(Progress, ANewStageBeginsAtZero) {
  Progress progress;
  progress.begin_stage("first", 2);
  progress.add(1);
  progress.begin_stage("second", 5);
  EXPECT_STREQ(progress.stage(), "second");
  EXPECT_EQ(progress.fraction(), 0.0);
}

TEST(Progress, StaysBetweenZeroAndOne) {
  Progress progress;
  progress.begin_stage("of unknown length", 0);
  progress.add(3);
  EXPECT_EQ(progress.fraction(), 0.0);
  progress.begin_stage("longer than announced", 2);
  progress.add(3);
  EXPECT_EQ(progress.fraction(), 1.0);
}

TEST(Cancellation, EndsTheThreadThatIsAskedWhereItMayEnd) {
  std::atomic<bool> asked{false};
  cancellation_point();
  const ScopedCancellation cancellation(asked);
  cancellation_point();
  asked = true;
  EXPECT_EQ(test::error_name(cancellation_point), "cancelled");
  std::thread([] { cancellation_point(); }).join();  // another thread goes on
}

TEST(Cancellation, TheInnermostCounts) {
  std::atomic<bool> outer{true}, inner{false};
  const ScopedCancellation outside(outer);
  {
    const ScopedCancellation inside(inner);
    cancellation_point();
  }
  EXPECT_EQ(test::error_name(cancellation_point), "cancelled");
}

}  // namespace
}  // namespace ist
