#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>

#include "c/follower.h"
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

/// Calls report every 0.2 ms in its lifetime, so that short ones report several times on a fast
/// machine too.
class FrequentReports {
 public:
  FrequentReports() { capi::time_between_reports() = std::chrono::microseconds(200); }
  ~FrequentReports() { capi::time_between_reports() = std::chrono::milliseconds(20); }
  FrequentReports(const FrequentReports&) = delete;
  FrequentReports& operator=(const FrequentReports&) = delete;
};

/// Makes a call of more and more work, as call(work, progress), until its second report comes
/// before its end, and ends it there. Expects that it makes no third report.
template <class Call>
void expect_ends_midway(const Call& call) {
  const FrequentReports frequent;
  Listener listener;
  const auto progress = sized<ist_progress>({0, Listener::hear, &listener});
  std::string status = "ok";
  for (std::size_t work = 1; status == "ok"; work *= 2) {
    ASSERT_LE(work, 1U << 12) << "the call is too short";
    listener = {.stop_at = 2};
    status = name(call(work, &progress));
  }
  EXPECT_EQ(status, "cancelled") << ist_last_error_message();
  EXPECT_EQ(listener.reports, 2);
  EXPECT_LT(listener.last, 1);
}

}  // namespace ist::test
