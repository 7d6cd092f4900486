// The loops of a build without TBB, in every build: this program is linked with thread_ranges.cpp.

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "ist/base/parallel.h"
#include "support/effort.h"

namespace ist {
namespace {

using namespace std::chrono_literals;

template <class Body>
void loop(std::size_t ranges, Body body) {
  run_ranges(
      ranges, [](void* context, std::size_t range) { (*static_cast<Body*>(context))(range); },
      &body);
}

// Returns the threads that ran a loop. Its ranges take a while, so that others may come.
std::set<std::thread::id> threads_of_a_loop(std::size_t ranges = 40) {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  loop(ranges, [&](std::size_t) {
    std::this_thread::sleep_for(200us);
    const std::lock_guard lock(mutex);
    seen.insert(std::this_thread::get_id());
  });
  return seen;
}

// Returns when two ranges of a loop have met. Each waits for the other to begin, so a loop of one
// thread never ends.
int two_at_once() {
  std::atomic<int> begun{0};
  loop(2, [&](std::size_t) {
    ++begun;
    while (begun < 2) std::this_thread::yield();
  });
  return begun;
}

// Returns when a loop has given the caller's thread a range. Each other thread keeps its first
// range until then, and there is a range for each.
bool gives_the_caller_one() {
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> given{false};
  loop(thread_count(), [&](std::size_t) {
    if (std::this_thread::get_id() == caller) given = true;
    while (!given) std::this_thread::yield();
  });
  return given;
}

TEST(ThreadRanges, RunsEachRangeOnceByNoMoreThreadsThanAreAllowed) {
  for (const std::size_t threads : {1u, 2u, 3u, 100u}) {
    const ScopedThreadLimit limit(threads);
    for (const std::size_t ranges : {0u, 1u, 2u, 1000u}) {
      std::vector<int> visits(ranges);
      loop(ranges, [&](std::size_t range) { ++visits[range]; });
      EXPECT_EQ(visits, std::vector<int>(ranges, 1));
    }
    EXPECT_LE(threads_of_a_loop().size(), std::min(threads, thread_count()));
  }
}

TEST(ThreadRanges, RunsTwoRangesAtOnceAndTheCallersThreadIsOneOfTheirs) {
  if (thread_count() < 2) IST_SKIP("this process may run on one processor");
  EXPECT_EQ(two_at_once(), 2);
  EXPECT_TRUE(gives_the_caller_one());
}

TEST(ThreadRanges, TheSmallestLivingLimitHoldsInEveryThread) {
  auto one = std::make_unique<ScopedThreadLimit>(1);
  const ScopedThreadLimit two(2);
  std::thread([] { EXPECT_EQ(threads_of_a_loop().size(), 1u); }).join();
  one.reset();
  EXPECT_TRUE(thread_count() < 2 || two_at_once() == 2);
  EXPECT_LE(threads_of_a_loop().size(), 2u);
}

TEST(ThreadRanges, ALoopWithinALoopRunsInTheThreadOfItsRange) {
  std::atomic<int> strangers{0}, ranges{0};
  loop(20, [&](std::size_t) {
    const std::thread::id mine = std::this_thread::get_id();
    loop(5, [&](std::size_t) {
      ++ranges;
      if (std::this_thread::get_id() != mine) ++strangers;
    });
  });
  EXPECT_EQ(ranges, 100);
  EXPECT_EQ(strangers, 0);
  EXPECT_TRUE(thread_count() < 2 || two_at_once() == 2);  // as before
}

TEST(ThreadRanges, TheFirstRangeThatFailsIsHeardWhenNoThreadRunsAnyMore) {
  for (int round = 0; round < test::samples(200); ++round) {
    std::atomic<int> running{0}, before{0};
    std::string heard;
    try {
      loop(64, [&](std::size_t range) {
        struct Running {
          std::atomic<int>& count;
          explicit Running(std::atomic<int>& c) : count(c) { ++count; }
          ~Running() { --count; }
        } counted(running);
        if (range < 5) ++before;
        if (range >= 5 && range % 2 == 1) throw std::runtime_error(std::to_string(range));
      });
    } catch (const std::runtime_error& error) {
      heard = error.what();
    }
    ASSERT_EQ(heard, "5");
    ASSERT_EQ(before, 5);
    ASSERT_EQ(running, 0);
  }
  EXPECT_TRUE(thread_count() < 2 || two_at_once() == 2);
}

// Gives new threads a stack that no process has room for, while it lives.
class NoThreadStarts {
 public:
  NoThreadStarts() {
    pthread_getattr_default_np(&saved_);
    pthread_attr_t huge;
    pthread_getattr_default_np(&huge);
    pthread_attr_setstacksize(&huge, std::size_t{1} << 50);
    pthread_setattr_default_np(&huge);
    pthread_attr_destroy(&huge);
  }
  ~NoThreadStarts() {
    pthread_setattr_default_np(&saved_);
    pthread_attr_destroy(&saved_);
  }

 private:
  pthread_attr_t saved_;
};

TEST(ThreadRanges, TheCallerDoesAllWhereNoThreadStarts) {
  const NoThreadStarts none;
  EXPECT_THROW(std::thread([] {}).join(), std::system_error);
  EXPECT_EQ(threads_of_a_loop(), std::set<std::thread::id>{std::this_thread::get_id()});
  run_aside([](void*) { FAIL() << "no thread can run it"; }, nullptr);
}

TEST(ThreadRanges, UsesTheProcessorsThatTheCallerMayRunOn) {
  std::thread([] {
    cpu_set_t allowed, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof(allowed), &allowed), 0);
    EXPECT_EQ(thread_count(), static_cast<std::size_t>(CPU_COUNT(&allowed)));
    int first = 0;
    while (!CPU_ISSET(static_cast<std::size_t>(first), &allowed)) ++first;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(first), &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
    EXPECT_EQ(thread_count(), 1u);
    EXPECT_EQ(threads_of_a_loop().size(), 1u);
  }).join();
}

TEST(ThreadRanges, WhatRunsAsideHasAThreadOfItsOwn) {
  static std::atomic<bool> ran{false}, mine{true};
  static const std::thread::id caller = std::this_thread::get_id();
  const ScopedThreadLimit one(1);
  run_aside(
      [](void*) {
        mine = std::this_thread::get_id() == caller;
        ran = true;
      },
      nullptr);
  while (!ran) std::this_thread::yield();  // or the test's time runs out
  EXPECT_FALSE(mine);
}

}  // namespace
}  // namespace ist
