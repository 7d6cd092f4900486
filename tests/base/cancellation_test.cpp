#include "ist/base/cancellation.h"

#include <gtest/gtest.h>

#include <thread>

#include "support/errors.h"

namespace ist {
namespace {

TEST(Cancellation, EndsTheThreadThatIsAskedWhereItMayEnd) {
  std::atomic<bool> asked{false};
  cancellation_point();
  const ScopedCancellation cancellation(asked);
  cancellation_point();
  asked = true;
  EXPECT_EQ(test::error_name(cancellation_point), "cancelled");
  std::thread([] { cancellation_point(); }).join();  // another thread goes on
}

TEST(Cancellation, TheInnermostCounts) {
  std::atomic<bool> outer{true}, inner{false};
  const ScopedCancellation outside(outer);
  {
    const ScopedCancellation inside(inner);
    cancellation_point();
  }
  EXPECT_EQ(test::error_name(cancellation_point), "cancelled");
}

}  // namespace
}  // namespace ist
