#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <barrier>
#include <chrono>
#include <cstring>
#include <thread>
#include <vector>

#include "c/follower.h"
#include "capi/c_bodies.h"
#include "ist/base/cancellation.h"
#include "ist/capi/ist_servo.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

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

class CServoThread : public ::testing::Test {
 protected:
  [[nodiscard]] ist_servo* open() const {
    const std::string file = folder_.write("scene.toml", kSmallScene).string();
    auto options = sized<ist_servo_options>();
    options.unit = IST_UNIT_MM;
    options.sphere_tests = 1'000'000;  // the same ticks in every run
    ist_servo* servo = nullptr;
    EXPECT_EQ(name(ist_servo_open_scene(file.c_str(), &options, &servo)), "ok")
        << ist_last_error_message();
    return servo;
  }
  // Makes the tick of that number: the device sinks. Returns the status.
  static ist_status tick(ist_servo* servo, const ist_servo_info& start, std::uint64_t number) {
    std::array<double, 16> pose;
    std::copy_n(start.tool, 16, pose.begin());
    pose[14] -= 0.005 * static_cast<double>(number);
    std::array<double, 3> force, torque;
    return ist_servo_on_tick(servo, pose.data(), force.data(), torque.data());
  }
  [[nodiscard]] static ist_servo_info info_of(ist_servo* servo) {
    auto info = sized<ist_servo_info>();
    EXPECT_EQ(name(ist_servo_get_info(servo, &info)), "ok");
    return info;
  }
  // Without the times, no two runs differ.
  [[nodiscard]] static bool equal(ist_servo_state a, ist_servo_state b) {
    for (ist_servo_state* state : {&a, &b}) state->begin_ns = state->execution_ns = 0;
    return std::memcmp(&a, &b, sizeof a) == 0;
  }

  const TempDir folder_;
};

// A thread reads the state while the loop is in its ticks. Neither finds the other one busy, and
// every state is that of one tick.
TEST_F(CServoThread, ReadsTheStateBesideTheLoop) {
  constexpr std::uint64_t kTicks = 500;
  ist_servo* first = open();
  const ist_servo_info start = info_of(first);
  std::vector<ist_servo_state> wanted(kTicks, sized<ist_servo_state>());
  for (std::uint64_t i = 0; i < kTicks; ++i) {
    ASSERT_EQ(name(tick(first, start, i)), "ok");
    ASSERT_EQ(name(ist_servo_get_state(first, &wanted[i])), "ok");
  }
  EXPECT_GT(wanted.back().force[2], 0.05);
  EXPECT_EQ(name(ist_servo_free(first)), "ok");

  ist_servo* servo = open();
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> latest{0};
  std::uint64_t seen = 0, mixed = 0, failed = 0, refused = 0;
  std::jthread reader([&] {
    while (!done) {
      auto state = sized<ist_servo_state>();
      failed += ist_servo_get_state(servo, &state) == IST_OK ? 0U : 1U;
      if (state.known == 0) continue;
      ++seen;
      mixed += equal(state, wanted.at(state.tick)) ? 0U : 1U;
      latest = state.tick;
    }
  });
  // Threads may share a core. So now and then the loop waits until the reader has its tick.
  for (std::uint64_t i = 0; i < kTicks; ++i) {
    refused += tick(servo, start, i) == IST_OK ? 0U : 1U;
    while (i % 20 == 19 && latest != i && refused == 0) std::this_thread::yield();
  }
  done = true;
  reader.join();
  EXPECT_EQ(refused, 0u) << "a reader never keeps the loop from its tick";
  EXPECT_EQ(failed, 0u) << "the loop never keeps a reader from the state";
  EXPECT_EQ(mixed, 0u);
  EXPECT_GE(seen, kTicks / 20);
  EXPECT_EQ(name(ist_servo_free(servo)), "ok");
}

TEST_F(CServoThread, ReadsTheStateUntilTheServoIsFreed) {
  ist_servo* servo = open();
  ASSERT_EQ(name(tick(servo, info_of(servo), 1)), "ok");
  std::barrier together(kThreads);
  run([&](int i) {
    auto state = sized<ist_servo_state>();
    EXPECT_EQ(name(ist_servo_get_state(servo, &state)), "ok");
    EXPECT_EQ(state.known, 1);
    together.arrive_and_wait();
    if (i == 0) {
      EXPECT_EQ(name(ist_servo_free(servo)), "ok");
    }
    ist_status status;
    while ((status = ist_servo_get_state(servo, &state)) == IST_OK) EXPECT_EQ(state.known, 1);
    EXPECT_EQ(name(status), "handle-freed");
    EXPECT_EQ(state.known, 0);
  });
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
