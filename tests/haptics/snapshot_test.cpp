#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <chrono>
#include <iostream>
#include <vector>

#include "ist/haptics/recording.h"

namespace ist::test {
namespace {

using namespace std::chrono_literals;

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
  constexpr std::uint64_t kEnough = 500;  // versions seen by a reader
  Snapshot<Words> snapshot;
  std::atomic<bool> done{false};
  struct Seen {
    std::atomic<std::uint64_t> versions{0};
    std::uint64_t torn = 0, backwards = 0, last = 0;
  };
  std::array<Seen, 2> seen;
  const auto note = [](Seen& mine, const Words& words) {
    if (!words.whole()) ++mine.torn;
    if (words.version < mine.last) ++mine.backwards;
    if (words.version != mine.last) mine.versions.fetch_add(1, std::memory_order_relaxed);
    mine.last = words.version;
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

  // Threads may share a core for a while and not meet.
  const auto end = std::chrono::steady_clock::now() + 3s;
  std::uint64_t version = 0;
  while (version < 20000 ||
         (std::chrono::steady_clock::now() < end &&
          (seen[0].versions.load() < kEnough || seen[1].versions.load() < kEnough))) {
    snapshot.publish(Words(++version));
    for (std::uint64_t pause = version % 512; pause > 0; --pause) _mm_pause();
  }
  done = true;
  for (std::thread& reader : readers) reader.join();
  for (const Seen& mine : seen) {
    EXPECT_EQ(mine.torn, 0u);
    EXPECT_EQ(mine.backwards, 0u);
    EXPECT_GT(mine.versions.load(), 0u);
  }
  EXPECT_EQ(snapshot.read().version, version);
  std::cout << "versions published: " << version << ", seen: " << seen[0].versions << " and "
            << seen[1].versions << '\n';
}

}  // namespace
}  // namespace ist::test
