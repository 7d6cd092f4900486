#include "ist/query/workers/resident_pool.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <vector>

#include "query/workers/stall.h"
#include "query/workers/worker_cases.h"

namespace ist::test {
namespace {

// Counts who did each item.
struct Items {
  static constexpr std::size_t kThreads = 4, kCount = 1000;

  static void take(void* self, std::size_t thread, std::size_t item) noexcept {
    Items& items = *static_cast<Items*>(self);
    ++items.done[item];
    ++items.by[thread];
  }

  std::vector<int> done = std::vector<int>(kCount, 0);
  std::array<std::atomic<std::uint64_t>, kThreads> by{};
};

TEST(ResidentPoolThread, DoesEachItemOnce) {
  for (std::size_t helpers = 0; helpers < Items::kThreads; ++helpers) {
    Items items;
    ResidentPool pool(helpers, &items, Items::take);
    for (int run = 1; run <= 200; ++run) {
      pool.run(Items::kCount);
      EXPECT_EQ(items.done, std::vector<int>(Items::kCount, run));
    }
    pool.run(0);
    EXPECT_EQ(items.done, std::vector<int>(Items::kCount, 200));
  }
}

TEST(ResidentPoolThread, IsHelpedByAWorkerThatIsAwake) {
  const Awake awake;
  Items items;
  ResidentPool pool(1, &items, Items::take);
  wait_until([&] {
    pool.run(Items::kCount);
    return items.by[1] > 0;
  });
}

// A worker that lost its core in an item is waited for.
TEST(ResidentPoolThread, WaitsForAnItemThatHasBegun) {
  struct Slow {
    static void take(void* self, std::size_t thread, std::size_t) noexcept {
      Slow& slow = *static_cast<Slow*>(self);
      if (thread > 0) {
        slow.begun = true;
        for (int k = 0; k < 1'000'000; ++k) slow.spin.fetch_add(1, std::memory_order_relaxed);
        slow.ended = true;
      }
    }
    std::atomic<bool> begun{false}, ended{false};
    std::atomic<int> spin{0};
  };
  const Awake awake;
  Slow slow;
  ResidentPool pool(1, &slow, Slow::take);
  wait_until([&] {
    pool.run(100);
    EXPECT_EQ(slow.begun, slow.ended);
    return slow.begun.load();
  });
}

}  // namespace
}  // namespace ist::test
