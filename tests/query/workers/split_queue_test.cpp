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
  SplitQueue queue(5);
  const std::uint64_t epoch = queue.open(5);
  EXPECT_EQ(queue.claim_front(), 0u);
  EXPECT_EQ(queue.claim_back(epoch), 4u);
  EXPECT_EQ(queue.claim_back(epoch), 3u);
  EXPECT_EQ(queue.claim_front(), 1u);
  EXPECT_EQ(queue.claim_front(), 2u);
  EXPECT_EQ(queue.claim_front(), std::nullopt);
  EXPECT_EQ(queue.claim_back(epoch), std::nullopt);
  EXPECT_EQ(queue.close(), 3u);
}

TEST(SplitQueue, TakesAnyNumberOfChunksUpToTheMost) {
  SplitQueue queue(SplitQueue::kMaxChunks);
  for (const std::size_t chunks : {std::size_t{0}, std::size_t{1}, SplitQueue::kMaxChunks}) {
    const std::uint64_t epoch = queue.open(chunks);
    std::size_t claimed = 0;
    while (claimed % 2 ? queue.claim_back(epoch) : queue.claim_front()) ++claimed;
    EXPECT_EQ(claimed, chunks);
  }
}

TEST(SplitQueue, CloseEndsClaimingAndTellsWhereTheHelpersChunksBegin) {
  SplitQueue queue(8);
  const std::uint64_t epoch = queue.open(8);
  EXPECT_EQ(queue.claim_front(), 0u);
  EXPECT_EQ(queue.claim_back(epoch), 7u);
  EXPECT_EQ(queue.claim_back(epoch), 6u);
  EXPECT_EQ(queue.close(), 6u);
  EXPECT_EQ(queue.claim_front(), std::nullopt);
  EXPECT_EQ(queue.claim_back(epoch), std::nullopt);
  EXPECT_EQ(queue.close(), 6u);
  EXPECT_TRUE(queue.complete(epoch, 7));  // what was claimed may still be finished
  EXPECT_TRUE(queue.collect(7, 0ns));
}

TEST(SplitQueue, AChunkIsFinishedOrDroppedAndStaysSo) {
  SplitQueue queue(2);
  const std::uint64_t epoch = queue.open(2);
  ASSERT_EQ(queue.claim_back(epoch), 1u);
  ASSERT_EQ(queue.claim_back(epoch), 0u);
  EXPECT_FALSE(queue.completed(1));
  EXPECT_TRUE(queue.complete(epoch, 1));
  EXPECT_TRUE(queue.completed(1));
  EXPECT_TRUE(queue.collect(1, 0ns));
  EXPECT_TRUE(queue.collect(1, 0ns));

  EXPECT_FALSE(queue.collect(0, 0ns));
  EXPECT_FALSE(queue.complete(epoch, 0));
  EXPECT_FALSE(queue.completed(0));
  EXPECT_FALSE(queue.collect(0, 0ns));
}

TEST(SplitQueue, AHelperOfAnEarlierEpochClaimsAndFinishesNothing) {
  SplitQueue queue(4);
  const std::uint64_t earlier = queue.open(4);
  ASSERT_EQ(queue.claim_back(earlier), 3u);
  const std::uint64_t epoch = queue.open(4);
  EXPECT_NE(epoch, earlier);
  EXPECT_EQ(queue.claim_back(earlier), std::nullopt);
  EXPECT_FALSE(queue.complete(earlier, 3));
  EXPECT_EQ(queue.claim_back(epoch), 3u);
  EXPECT_FALSE(queue.complete(earlier, 3));
  EXPECT_FALSE(queue.completed(3));
  EXPECT_TRUE(queue.complete(epoch, 3));
}

TEST(SplitQueue, WaitsForAClaimedChunkAsLongAsItIsTold) {
  SplitQueue queue(1);
  const std::uint64_t epoch = queue.open(1);
  ASSERT_EQ(queue.claim_back(epoch), 0u);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(queue.collect(0, 2ms));
  EXPECT_GE(std::chrono::steady_clock::now() - start, 2ms);
}

// A helper on a thread of its own, there from the first: claims all it can of the epoch that it was
// told of last.
template <typename Work>
class Helper {
 public:
  Helper(SplitQueue& queue, Work work)
      : thread_([this, &queue, work](const std::stop_token& stop) {
          here_ = true;
          while (!stop.stop_requested()) {
            const std::uint64_t epoch = epoch_.load(std::memory_order_acquire);
            while (const auto chunk = queue.claim_back(epoch)) {
              claimed_in_.store(epoch, std::memory_order_relaxed);
              work(epoch, *chunk);
            }
          }
        }) {
    while (!here_) std::this_thread::yield();
  }
  void tell(std::uint64_t epoch) { epoch_.store(epoch, std::memory_order_release); }
  // Waits until it has claimed a chunk in this epoch. Only the queue orders what both write.
  void wait_for_claim(std::uint64_t epoch) const {
    while (claimed_in_.load(std::memory_order_relaxed) != epoch) std::this_thread::yield();
  }

 private:
  std::atomic<bool> here_{false};
  std::atomic<std::uint64_t> epoch_{0}, claimed_in_{0};
  std::jthread thread_;
};

void pause(std::uint64_t times) {
  while (times-- > 0) _mm_pause();
}

TEST(SplitQueueThread, EachChunkIsDoneOnceAndItsResultIsSeen) {
  constexpr std::size_t kMost = 200;
  constexpr std::uint64_t kRounds = 3000, kEvery = 16;
  SplitQueue queue(kMost);
  std::vector<std::uint64_t> given(kMost), made(kMost);  // nothing atomic: the queue orders them
  std::vector<int> times(kMost);
  const auto work = [&](std::size_t i) {
    made[i] = given[i] * given[i];
    ++times[i];
    pause(i % 4);
  };
  Helper helper(queue, [&](std::uint64_t epoch, std::size_t i) {
    work(i);
    EXPECT_TRUE(queue.complete(epoch, i));
  });
  std::size_t helped = 0, all = 0;
  for (std::uint64_t round = 0; round < kRounds; ++round) {
    const std::size_t chunks = 1 + round % kMost;
    times.assign(kMost, 0);
    std::iota(given.begin(), given.end(), round);
    const std::uint64_t epoch = queue.open(chunks);
    helper.tell(epoch);
    if (round % kEvery == 0) helper.wait_for_claim(epoch);  // in the others it may come or not
    while (const auto i = queue.claim_front()) work(*i);
    const std::size_t back = queue.close();
    for (std::size_t i = back; i < chunks; ++i) ASSERT_TRUE(queue.collect(i, 1h));
    helped += chunks - back;
    all += chunks;
    for (std::size_t i = 0; i < chunks; ++i) {
      ASSERT_EQ(times[i], 1);
      ASSERT_EQ(made[i], (round + i) * (round + i));
    }
  }
  EXPECT_GE(helped, kRounds / kEvery);
  std::cout << "chunks done by the helper: " << helped << " of " << all << '\n';
}

// In most rounds nobody knows who wins. In a few the helper is in time, and in a few it is late.
TEST(SplitQueueThread, DroppingAndFinishingHaveOneWinner) {
  constexpr std::size_t kChunks = 8;
  constexpr std::uint64_t kRounds = 30000, kEvery = 256;
  SplitQueue queue(kChunks);
  std::vector<std::uint64_t> made(kChunks * (kRounds + 1));
  std::atomic<std::uint64_t> late_in{0};  // an epoch: the helper waits while it is this one
  Helper helper(queue, [&](std::uint64_t epoch, std::size_t i) {
    // Written before finishing; read by the caller only where it is told that it was finished.
    made[epoch * kChunks + i] = epoch;
    pause(epoch % 16);
    while (late_in == epoch) std::this_thread::yield();
    if (!queue.complete(epoch, i)) made[epoch * kChunks + i] = 0;
  });
  std::vector<std::size_t> taken;
  std::size_t dropped = 0;
  for (std::uint64_t round = 0; round < kRounds && !::testing::Test::HasFailure(); ++round) {
    const std::uint64_t epoch = queue.open(kChunks);
    ASSERT_LE(epoch, kRounds);
    const bool in_time = round % kEvery == 0, late = round % kEvery == kEvery / 2;
    if (late) late_in = epoch;
    helper.tell(epoch);
    while (in_time && !queue.completed(kChunks - 1)) std::this_thread::yield();
    if (late) helper.wait_for_claim(epoch);
    pause(round % 64);  // it claims some
    for (std::size_t i = queue.close(); i < kChunks; ++i) {
      if (queue.collect(i, std::chrono::nanoseconds(round % 300))) {
        EXPECT_FALSE(late);
        EXPECT_EQ(made[epoch * kChunks + i], epoch);
        taken.push_back(epoch * kChunks + i);
      } else {
        ++dropped;
      }
    }
    late_in = 0;
  }
  for (const std::size_t i : taken) ASSERT_EQ(made[i], i / kChunks);  // its complete() said so too
  EXPECT_GE(taken.size(), kRounds / kEvery);
  EXPECT_GE(dropped, kRounds / kEvery);
  std::cout << "taken: " << taken.size() << ", dropped: " << dropped << '\n';
}

// An epoch is opened over another in the midst of which the helper is, and which it goes on with.
TEST(SplitQueueThread, AHelperOfAnEarlierEpochSpoilsNothing) {
  constexpr std::size_t kChunks = 16;
  constexpr std::uint64_t kRounds = 20000, kEvery = 128;
  SplitQueue queue(kChunks);
  std::atomic<std::size_t> helped{0};
  std::atomic<std::uint64_t> late_in{0};  // an epoch: the helper waits while it is this one
  std::atomic<std::uint64_t> ended{0};    // twice the epoch of its last chunk, 1 more if completed
  Helper helper(queue, [&](std::uint64_t epoch, std::size_t i) {
    pause(i % 4);
    while (late_in == epoch) std::this_thread::yield();
    const bool completed = queue.complete(epoch, i);
    ended.store(2 * epoch + (completed ? 1 : 0), std::memory_order_relaxed);
    helped.fetch_add(1, std::memory_order_relaxed);
  });
  for (std::uint64_t round = 0; round < kRounds && !::testing::Test::HasFailure(); ++round) {
    const bool late = round % kEvery == 0;  // in the other rounds it may be late or not
    const std::uint64_t earlier = queue.open(kChunks);
    if (late) late_in = earlier;
    helper.tell(earlier);
    if (late) helper.wait_for_claim(earlier);
    pause(round % 64);
    queue.open(kChunks);
    for (std::size_t i = 0; i < kChunks; ++i) {
      EXPECT_EQ(queue.claim_front(), i);
      if (i == kChunks / 2) {
        late_in = 0;
        while (late && ended / 2 != earlier) std::this_thread::yield();
        EXPECT_TRUE(!late || ended == 2 * earlier);
      }
      EXPECT_FALSE(queue.completed(i));
    }
    EXPECT_EQ(queue.claim_front(), std::nullopt);
    EXPECT_EQ(queue.close(), kChunks);
  }
  EXPECT_GE(helped, kRounds / kEvery);
  std::cout << "claims in earlier epochs, before they were over: " << helped << '\n';
}

}  // namespace
}  // namespace ist
