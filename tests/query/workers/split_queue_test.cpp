#include "ist/query/workers/split_queue.h"

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <iostream>
#include <numeric>
#include <thread>
#include <vector>

namespace ist {
namespace {

using namespace std::chrono_literals;

TEST(SplitQueue, TheCallerClaimsFromTheFrontAndTheHelperFromTheBack) {
  SplitQueue board(5);
  const std::uint64_t epoch = board.open(5);
  EXPECT_EQ(board.claim_front(), 0u);
  EXPECT_EQ(board.claim_back(epoch), 4u);
  EXPECT_EQ(board.claim_back(epoch), 3u);
  EXPECT_EQ(board.claim_front(), 1u);
  EXPECT_EQ(board.claim_front(), 2u);
  EXPECT_EQ(board.claim_front(), std::nullopt);
  EXPECT_EQ(board.claim_back(epoch), std::nullopt);
  EXPECT_EQ(board.close(), 3u);
}

TEST(SplitQueue, TakesAnyNumberOfChunksUpToTheMost) {
  SplitQueue board(SplitQueue::kMaxChunks);
  for (const std::size_t chunks : {std::size_t{0}, std::size_t{1}, SplitQueue::kMaxChunks}) {
    const std::uint64_t epoch = board.open(chunks);
    std::size_t claimed = 0;
    while (claimed % 2 ? board.claim_back(epoch) : board.claim_front()) ++claimed;
    EXPECT_EQ(claimed, chunks);
  }
}

TEST(SplitQueue, CloseEndsClaimingAndTellsWhereTheHelpersChunksBegin) {
  SplitQueue board(8);
  const std::uint64_t epoch = board.open(8);
  EXPECT_EQ(board.claim_front(), 0u);
  EXPECT_EQ(board.claim_back(epoch), 7u);
  EXPECT_EQ(board.claim_back(epoch), 6u);
  EXPECT_EQ(board.close(), 6u);
  EXPECT_EQ(board.claim_front(), std::nullopt);
  EXPECT_EQ(board.claim_back(epoch), std::nullopt);
  EXPECT_EQ(board.close(), 6u);
  EXPECT_TRUE(board.complete(epoch, 7));  // what was claimed may still be finished
  EXPECT_TRUE(board.collect(7, 0ns));
}

TEST(SplitQueue, AChunkIsFinishedOrDroppedAndStaysSo) {
  SplitQueue board(2);
  const std::uint64_t epoch = board.open(2);
  ASSERT_EQ(board.claim_back(epoch), 1u);
  ASSERT_EQ(board.claim_back(epoch), 0u);
  EXPECT_FALSE(board.completed(1));
  EXPECT_TRUE(board.complete(epoch, 1));
  EXPECT_TRUE(board.completed(1));
  EXPECT_TRUE(board.collect(1, 0ns));
  EXPECT_TRUE(board.collect(1, 0ns));

  EXPECT_FALSE(board.collect(0, 0ns));
  EXPECT_FALSE(board.complete(epoch, 0));
  EXPECT_FALSE(board.completed(0));
  EXPECT_FALSE(board.collect(0, 0ns));
}

TEST(SplitQueue, AHelperOfAnEarlierEpochClaimsAndFinishesNothing) {
  SplitQueue board(4);
  const std::uint64_t earlier = board.open(4);
  ASSERT_EQ(board.claim_back(earlier), 3u);
  const std::uint64_t epoch = board.open(4);
  EXPECT_NE(epoch, earlier);
  EXPECT_EQ(board.claim_back(earlier), std::nullopt);
  EXPECT_FALSE(board.complete(earlier, 3));
  EXPECT_EQ(board.claim_back(epoch), 3u);
  EXPECT_FALSE(board.complete(earlier, 3));
  EXPECT_FALSE(board.completed(3));
  EXPECT_TRUE(board.complete(epoch, 3));
}

TEST(SplitQueue, WaitsForAClaimedChunkAsLongAsItIsTold) {
  SplitQueue board(1);
  const std::uint64_t epoch = board.open(1);
  ASSERT_EQ(board.claim_back(epoch), 0u);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(board.collect(0, 2ms));
  EXPECT_GE(std::chrono::steady_clock::now() - start, 2ms);
}

// A helper on a thread of its own, there from the first: claims all it can of the epoch that it was
// told of last.
template <typename Work>
class Helper {
 public:
  Helper(SplitQueue& board, Work work)
      : thread_([this, &board, work](const std::stop_token& stop) {
          here_ = true;
          while (!stop.stop_requested()) {
            const std::uint64_t epoch = epoch_.load(std::memory_order_acquire);
            while (const auto chunk = board.claim_back(epoch)) work(epoch, *chunk);
          }
        }) {
    while (!here_) std::this_thread::yield();
  }
  void tell(std::uint64_t epoch) { epoch_.store(epoch, std::memory_order_release); }

 private:
  std::atomic<bool> here_{false};
  std::atomic<std::uint64_t> epoch_{0};
  std::jthread thread_;
};

void pause(std::uint64_t times) {
  while (times-- > 0) _mm_pause();
}

// Goes on until `enough` is seen, for three seconds at most: two threads may share a core for
// a while and not meet.
class Rounds {
 public:
  bool more(bool enough) const { return !enough && std::chrono::steady_clock::now() < end_; }

 private:
  std::chrono::steady_clock::time_point end_ = std::chrono::steady_clock::now() + 3s;
};

TEST(SplitQueueThread, EachChunkIsDoneOnceAndItsResultIsSeen) {
  constexpr std::size_t kMost = 200;
  SplitQueue board(kMost);
  std::vector<std::uint64_t> given(kMost), made(kMost);  // nothing atomic: the board orders them
  std::vector<int> times(kMost);
  const auto work = [&](std::size_t i) {
    made[i] = given[i] * given[i];
    ++times[i];
    pause(i % 4);
  };
  Helper helper(board, [&](std::uint64_t epoch, std::size_t i) {
    work(i);
    EXPECT_TRUE(board.complete(epoch, i));
  });
  std::size_t helped = 0, all = 0;
  const Rounds rounds;
  for (std::uint64_t round = 0; rounds.more(round >= 3000 && helped > 20000); ++round) {
    const std::size_t chunks = 1 + round % kMost;
    times.assign(kMost, 0);
    std::iota(given.begin(), given.end(), round);
    helper.tell(board.open(chunks));
    while (const auto i = board.claim_front()) work(*i);
    const std::size_t back = board.close();
    for (std::size_t i = back; i < chunks; ++i) ASSERT_TRUE(board.collect(i, 60s));
    helped += chunks - back;
    all += chunks;
    for (std::size_t i = 0; i < chunks; ++i) {
      ASSERT_EQ(times[i], 1);
      ASSERT_EQ(made[i], (round + i) * (round + i));
    }
  }
  std::cout << "chunks done by the helper: " << helped << " of " << all << '\n';
}

TEST(SplitQueueThread, DroppingAndFinishingHaveOneWinner) {
  constexpr std::size_t kChunks = 8;
  constexpr std::uint64_t kRounds = 200000;
  SplitQueue board(kChunks);
  std::vector<std::uint64_t> made(kChunks * (kRounds + 1));
  Helper helper(board, [&](std::uint64_t epoch, std::size_t i) {
    // Written before finishing; read by the caller only where it is told that it was finished.
    made[epoch * kChunks + i] = epoch;
    pause(epoch % 16);
    if (!board.complete(epoch, i)) made[epoch * kChunks + i] = 0;
  });
  std::vector<std::size_t> taken;
  std::size_t dropped = 0;
  const Rounds rounds;
  for (std::uint64_t round = 0;
       round < kRounds && rounds.more(taken.size() > 10000 && dropped > 100); ++round) {
    const std::uint64_t epoch = board.open(kChunks);
    ASSERT_LE(epoch, kRounds);
    helper.tell(epoch);
    pause(round % 64);  // it claims some
    for (std::size_t i = board.close(); i < kChunks; ++i) {
      if (board.collect(i, std::chrono::nanoseconds(round % 300))) {
        ASSERT_EQ(made[epoch * kChunks + i], epoch);
        taken.push_back(epoch * kChunks + i);
      } else {
        ++dropped;
      }
    }
  }
  for (const std::size_t i : taken) ASSERT_EQ(made[i], i / kChunks);  // its complete() said so too
  std::cout << "taken: " << taken.size() << ", dropped: " << dropped << '\n';
}

TEST(SplitQueueThread, AHelperOfAnEarlierEpochSpoilsNothing) {
  // An epoch is opened over another in the midst of which the helper is, and which it goes on with.
  constexpr std::size_t kChunks = 16;
  SplitQueue board(kChunks);
  std::atomic<std::size_t> helped{0};
  Helper helper(board, [&](std::uint64_t epoch, std::size_t i) {
    pause(i % 4);
    static_cast<void>(board.complete(epoch, i));
    helped.fetch_add(1, std::memory_order_relaxed);
  });
  const Rounds rounds;
  for (std::uint64_t round = 0; rounds.more(round >= 20000 && helped > 20000); ++round) {
    helper.tell(board.open(kChunks));
    pause(round % 64);
    board.open(kChunks);
    for (std::size_t i = 0; i < kChunks; ++i) {
      ASSERT_EQ(board.claim_front(), i);
      ASSERT_FALSE(board.completed(i));
    }
    ASSERT_EQ(board.claim_front(), std::nullopt);
    ASSERT_EQ(board.close(), kChunks);
  }
  std::cout << "claims in earlier epochs, before they were over: " << helped << '\n';
}

}  // namespace
}  // namespace ist
