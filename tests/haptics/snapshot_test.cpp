#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <array>
#include <atomic>
#include <iostream>
#include <thread>
#include <vector>

#include "ist/haptics/recording.h"

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

}  // namespace
}  // namespace ist::test
