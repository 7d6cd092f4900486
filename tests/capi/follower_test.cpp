#include "ist/capi/follower.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "capi/c_bodies.h"
#include "ist/base/cancellation.h"

namespace ist::test {
namespace {

using namespace std::chrono_literals;

// Ends a call at its second report.
std::int32_t stop_at_the_second(void* user, double /*part*/) {
  return ++*static_cast<int*>(user) == 2 ? 1 : 0;
}

TEST(CFollower, EndsWorkAtItsNextCancellationPoint) {
  int reports = 0;
  const capi::Follower follower = sized<ist_progress>({0, stop_at_the_second, &reports});
  // The work has no other end.
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
