#include "ist/base/parallel.h"

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <vector>

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
  // A new thread: TBB keeps the arithmetic in which it first meets one.
  std::thread([&] {
    _mm_setcsr(kDefault | kFlushToZero | kRoundUp);
    parallel_for(64, 1, [&](std::size_t begin, std::size_t) { seen[begin] = _mm_getcsr(); });
    after = _mm_getcsr();
  }).join();
  EXPECT_EQ(seen, std::vector<unsigned>(64, kDefault));
  EXPECT_EQ(after & (kFlushToZero | kRoundUp), kFlushToZero | kRoundUp);
}

}  // namespace
}  // namespace ist
