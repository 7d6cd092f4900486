#include "query/layout.h"

#include <gtest/gtest.h>

namespace ist::test {
namespace {

// A consumer may be compiled for another instruction set than the library. Where sizes are rounded
// up anyway a member could hide; check_house.sh looks for the types that move.
TEST(Layout, IsTheSameForEveryInstructionSet) { EXPECT_EQ(kWideLayout, public_layout()); }

}  // namespace
}  // namespace ist::test
