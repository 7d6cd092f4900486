#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <chrono>
#include <thread>
#include <vector>

#include "c/follower.h"
#include "capi/c_bodies.h"
#include "ist/base/cancellation.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// Simultaneous calls: any calls with different handles; calls with the same handle give at worst an
// error code.

constexpr int kThreads = 4;

template <typename Work>
void run(const Work& work) {
  std::barrier together(kThreads);
  std::vector<std::jthread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] {
      together.arrive_and_wait();
      work(i);
    });
  }
}

TEST(CThread, HasAMessageOfItsOwn) {
  std::barrier together(kThreads);
  std::array<std::string, kThreads> messages;
  const std::string before = ist_last_error_message();
  run([&](int i) {
    EXPECT_STREQ(ist_last_error_message(), "");
    ist_mesh* mesh = nullptr;
    const std::string path = "/no/such/mesh" + std::to_string(i);
    EXPECT_EQ(name(ist_mesh_read(path.c_str(), nullptr, &mesh)), "file-unreadable");
    together.arrive_and_wait();
    messages[static_cast<std::size_t>(i)] = ist_last_error_message();
  });
  for (int i = 0; i < kThreads; ++i) {
    const std::string& message = messages[static_cast<std::size_t>(i)];
    EXPECT_NE(message.find("ist_mesh_read: /no/such/mesh" + std::to_string(i)), std::string::npos)
        << message;
  }
  EXPECT_EQ(ist_last_error_message(), before);
}

// Each thread queries the same tree while one of them frees it.
TEST(CThread, MayUseATreeThatAnotherFrees) {
  ist_tree* tree = c_tree(icosphere(2, 1), 0.2);
  std::barrier together(kThreads);
  std::array<std::uint64_t, kThreads> leaf_pairs{};
  run([&](int i) {
    ist_query* query = nullptr;
    EXPECT_EQ(name(ist_query_create(tree, tree, nullptr, &query)), "ok");
    together.arrive_and_wait();
    if (i == 0) {
      EXPECT_EQ(name(ist_tree_free(tree)), "ok");
    }
    auto info = sized<ist_tree_info>();
    const ist_status status = ist_tree_get_info(tree, &info);
    EXPECT_TRUE(status == IST_OK ? info.leaves > 0 : status == IST_HANDLE_FREED && info.leaves == 0)
        << name(status);
    auto result = sized<ist_query_result>();
    EXPECT_EQ(
        name(ist_query_leaf_pairs(query, c_shift(1.7, 0, 0).data(), nullptr, nullptr, 0, &result)),
        "ok");
    leaf_pairs[static_cast<std::size_t>(i)] = result.leaf_pairs;
    EXPECT_EQ(name(ist_query_free(query)), "ok");
  });
  for (const std::uint64_t count : leaf_pairs) EXPECT_EQ(count, leaf_pairs[0]);
  EXPECT_GT(leaf_pairs[0], 10u);
}

// All threads use one query: each call gives the answer or IST_HANDLE_BUSY.
TEST(CThread, IsToldWhereItsQueryIsBusy) {
  ist_query* query = c_query(c_tree(icosphere(3, 1), 0.1));
  auto expected = sized<ist_query_result>();
  ASSERT_EQ(
      name(ist_query_leaf_pairs(query, c_shift(1.5, 0, 0).data(), nullptr, nullptr, 0, &expected)),
      "ok");
  std::atomic<int> answered{0}, busy{0};
  run([&](int) {
    // Sooner or later a thread loses its core in a call, and another one finds the query busy.
    for (int i = 0; i < 100 || busy == 0; ++i) {
      auto result = sized<ist_query_result>();
      const ist_status status =
          ist_query_leaf_pairs(query, c_shift(1.5, 0, 0).data(), nullptr, nullptr, 0, &result);
      if (status == IST_OK) {
        EXPECT_EQ(result.leaf_pairs, expected.leaf_pairs);
        EXPECT_EQ(result.sphere_tests, expected.sphere_tests);
        ++answered;
      } else {
        EXPECT_EQ(name(status), "handle-busy");
        EXPECT_EQ(result.leaf_pairs, 0u);
        ++busy;
      }
    }
  });
  EXPECT_GT(answered, 0);
  EXPECT_EQ(name(ist_query_free(query)), "ok");
}

using namespace std::chrono_literals;

// Ends a call at its second report.
std::int32_t stop_at_the_second(void* user, double /*part*/) {
  return ++*static_cast<int*>(user) == 2 ? 1 : 0;
}

TEST(CFollower, EndsWorkAtItsNextCancellationPoint) {
  int reports = 0;
  const capi::Follower follower = sized<ist_progress>({0, stop_at_the_second, &reports});
  // The work ends only by the stop.
  EXPECT_FALSE(capi::followed(follower, [](const Proceed& /*unasked*/) {
    for (;;) {
      cancellation_point();
      std::this_thread::sleep_for(1ms);
    }
  }));
  EXPECT_EQ(reports, 2);
}

}  // namespace
}  // namespace ist::test
