#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <thread>

#include "c_bodies.h"

namespace ist::test {

/// Counts the reports of a call, and ends it at one of them.
struct Listener {
  int stop_at = 0;  // 0: never
  int reports = 0;
  double last = 0;
  std::thread::id thread = std::this_thread::get_id();

  static std::int32_t hear(void* user, double part) {
    auto& self = *static_cast<Listener*>(user);
    EXPECT_EQ(std::this_thread::get_id(), self.thread);
    EXPECT_GE(part, 0);
    EXPECT_LE(part, 1);
    self.last = part;
    return ++self.reports == self.stop_at ? 1 : 0;
  }
};

/// Makes a call twice, as call(progress), and expects that its second report, 20 ms after it began,
/// ends the second one long before its end.
template <class Call>
void expect_ends_midway(const Call& call) {
  using Clock = std::chrono::steady_clock;
  Listener listener;
  const auto progress = sized<ist_progress>({0, Listener::hear, &listener});
  auto began = Clock::now();
  ASSERT_EQ(name(call(&progress)), "ok") << ist_last_error_message();
  const auto whole = Clock::now() - began;
  ASSERT_GE(listener.reports, 4) << "the call is too short";
  listener = {.stop_at = 2};
  began = Clock::now();
  EXPECT_EQ(name(call(&progress)), "cancelled");
  EXPECT_LT(Clock::now() - began, whole / 2);
  EXPECT_EQ(listener.reports, 2);
}

}  // namespace ist::test
