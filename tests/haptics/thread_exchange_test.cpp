#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <iostream>
#include <thread>
#include <vector>

#include "ist/haptics/recording.h"
#include "support/errors.h"
#include "support/random.h"

namespace ist::test {
namespace {

template <std::size_t kSize>
void expect_whole() {
  using Bytes = std::array<unsigned char, kSize>;
  Bytes first, second;
  for (std::size_t i = 0; i < kSize; ++i) {
    first[i] = static_cast<unsigned char>(i + 1);
    second[i] = static_cast<unsigned char>(200 - i);
  }
  Snapshot<Bytes> snapshot(first);
  EXPECT_EQ(snapshot.try_read(), first) << kSize;
  snapshot.publish(second);
  EXPECT_EQ(snapshot.try_read(), second) << kSize;
  EXPECT_EQ(snapshot.read(), second) << kSize;
}

TEST(Snapshot, HoldsTheLastValueWholeWhateverItsSize) {
  expect_whole<1>();
  expect_whole<7>();
  expect_whole<8>();
  expect_whole<9>();
  expect_whole<100>();
}

TEST(Snapshot, HoldsAValueByDefaultBeforeAnyIsPublished) {
  struct State {
    double force = 1.5;
    int tick = -1;
  };
  const Snapshot<State> snapshot;
  const State state = snapshot.read();
  EXPECT_EQ(state.force, 1.5);
  EXPECT_EQ(state.tick, -1);
}

// All words follow from the version, so that a mixture of two is told.
struct Words {
  static constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;

  explicit Words(std::uint64_t v = 0) : version(v) {
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = v * (kOdd + 2 * i);
  }
  bool whole() const {
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (rest[i] != version * (kOdd + 2 * i)) return false;
    }
    return true;
  }
  std::uint64_t version;
  std::array<std::uint64_t, 15> rest;
};

TEST(SnapshotThreads, ReadersSeeNoTornValueAndNoneEarlierThanTheLast) {
  constexpr std::uint64_t kVersions = 20000, kEvery = 512;
  Snapshot<Words> snapshot;
  std::atomic<bool> done{false};
  struct Seen {
    std::atomic<std::uint64_t> latest{0};
    std::uint64_t versions = 0, torn = 0, backwards = 0, last = 0;
  };
  std::array<Seen, 2> seen;
  const auto note = [](Seen& mine, const Words& words) {
    if (!words.whole()) ++mine.torn;
    if (words.version < mine.last) ++mine.backwards;
    if (words.version != mine.last) ++mine.versions;
    mine.last = words.version;
    mine.latest.store(words.version, std::memory_order_relaxed);
  };
  std::vector<std::thread> readers;
  readers.emplace_back([&] {
    while (!done.load(std::memory_order_relaxed)) {
      if (const auto words = snapshot.try_read()) note(seen[0], *words);
    }
  });
  readers.emplace_back([&] {
    while (!done.load(std::memory_order_relaxed)) note(seen[1], snapshot.read());
  });

  // Threads may share a core. So now and then the writer waits until both readers have its version.
  for (std::uint64_t version = 1; version <= kVersions; ++version) {
    snapshot.publish(Words(version));
    for (std::uint64_t pause = version % 512; pause > 0; --pause) _mm_pause();
    for (const Seen& reader : seen) {
      while (version % kEvery == 0 && reader.latest.load(std::memory_order_relaxed) != version)
        std::this_thread::yield();
    }
  }
  done = true;
  for (std::thread& reader : readers) reader.join();
  for (const Seen& mine : seen) {
    EXPECT_EQ(mine.torn, 0u);
    EXPECT_EQ(mine.backwards, 0u);
    EXPECT_GE(mine.versions, kVersions / kEvery);
  }
  EXPECT_EQ(snapshot.read().version, kVersions);
  std::cout << "versions published: " << kVersions << ", seen: " << seen[0].versions << " and "
            << seen[1].versions << '\n';
}

TEST(TickRing, RoundsItsRoomUpToAPowerOfTwo) {
  for (const auto& [asked, given] : {std::pair{1u, 1u}, {2u, 2u}, {3u, 4u}, {1000u, 1024u}}) {
    TickRing<int> ring(asked);
    EXPECT_EQ(ring.capacity(), given);
    for (unsigned i = 0; i < given; ++i) EXPECT_TRUE(ring.push(7)) << asked;
    EXPECT_FALSE(ring.push(7)) << asked;
  }
}

TEST(TickRing, GivesNothingWhenEmptyAndTakesNothingWhenFull) {
  TickRing<int> ring(4);
  std::array<int, 8> out{};
  EXPECT_EQ(ring.pop(out), 0u);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(4));
  EXPECT_EQ(ring.pop(std::span<int>()), 0u);
  EXPECT_FALSE(ring.push(5));
  EXPECT_EQ(ring.pop(std::span(out).first(1)), 1u);
  EXPECT_EQ(out[0], 0);
  EXPECT_TRUE(ring.push(6));
  EXPECT_FALSE(ring.push(7));
  ASSERT_EQ(ring.pop(out), 4u);
  EXPECT_EQ(std::vector<int>(out.begin(), out.begin() + 4), (std::vector<int>{1, 2, 3, 6}));
  EXPECT_EQ(ring.pop(out), 0u);
}

TEST(TickRing, KeepsTheOrderRoundAndRound) {
  TickRing<std::uint64_t> ring(8);
  std::deque<std::uint64_t> model;
  Random random(3);
  std::uint64_t next = 0;
  for (int turn = 0; turn < 5000; ++turn) {
    for (std::uint32_t n = random.below(12); n > 0; --n) {
      ASSERT_EQ(ring.push(next), model.size() < 8);
      if (model.size() < 8) model.push_back(next);
      ++next;
    }
    std::vector<std::uint64_t> out(random.below(12));
    const std::size_t count = ring.pop(out);
    ASSERT_EQ(count, std::min(out.size(), model.size()));
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(out[i], model.front());
      model.pop_front();
    }
  }
}

TEST(TickRingThreads, WhatIsPushedIsPoppedOnceInOrderAndWhole) {
  struct Record {
    std::uint64_t number, square, cube;
  };
  constexpr std::uint64_t kTicks = 400000;
  TickRing<Record> ring(64);
  std::uint64_t lost = 0;
  std::thread producer([&] {
    for (std::uint64_t i = 1; i <= kTicks; ++i) {
      const Record record{i, i * i, i * i * i};
      if (i % 2 == 0) {
        if (!ring.push(record)) ++lost;  // as the loop does
      } else {
        while (!ring.push(record)) std::this_thread::yield();
      }
    }
  });
  std::uint64_t popped = 0, skipped = 0, last = 0, spoilt = 0, unordered = 0;
  std::array<Record, 24> out;
  while (last < kTicks - 1) {  // an odd one, which is not lost
    const std::size_t count = ring.pop(out);
    if (count == 0) std::this_thread::yield();
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t n = out[i].number;
      if (out[i].square != n * n || out[i].cube != n * n * n) ++spoilt;
      if (n <= last) ++unordered;
      skipped += n - last - 1;
      last = n;
    }
    popped += count;
  }
  producer.join();
  for (std::size_t count; (count = ring.pop(out)) > 0; popped += count)
    last = out[count - 1].number;
  skipped += kTicks - last;
  EXPECT_EQ(spoilt, 0u);
  EXPECT_EQ(unordered, 0u);
  EXPECT_EQ(popped + lost, kTicks);
  EXPECT_EQ(skipped, lost);
  std::cout << "records popped: " << popped << ", lost: " << lost << '\n';
}

TEST(TickRing, RefusesACapacityOutOfRange) {
  for (const std::size_t capacity : {std::size_t{0}, (std::size_t{1} << 32) + 1, SIZE_MAX}) {
    const std::optional<Error> error = error_of([&] { TickRing<int> ring(capacity); });
    ASSERT_TRUE(error) << capacity;
    EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
  }
}

}  // namespace
}  // namespace ist::test
