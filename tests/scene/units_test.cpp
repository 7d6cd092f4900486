#include <gtest/gtest.h>

#include "ist/scene/ranges.h"

namespace ist::test {
namespace {

TEST(Units, AreKnownByTheirNamesAndNoOthers) {
  EXPECT_EQ(metres_in("m"), 1.0);
  EXPECT_EQ(metres_in("cm"), 1e-2);
  EXPECT_EQ(metres_in("mm"), 1e-3);
  EXPECT_EQ(metres_in("um"), 1e-6);
  EXPECT_EQ(metres_in("inch"), 0.0254);
  for (const char* other : {"", "MM", "millimetre", "mm ", "ft", "in"}) {
    EXPECT_FALSE(metres_in(other)) << other;
  }
}

}  // namespace
}  // namespace ist::test
