#include "ist/scene/spelling.h"

#include <gtest/gtest.h>

#include <string>

namespace ist::test {
namespace {

TEST(Spelling, CountsEdits) {
  EXPECT_EQ(edits("", ""), 0u);
  EXPECT_EQ(edits("mass", "mass"), 0u);
  EXPECT_EQ(edits("", "mass"), 4u);
  EXPECT_EQ(edits("mas", "mass"), 1u);
  EXPECT_EQ(edits("masss", "mass"), 1u);
  EXPECT_EQ(edits("mess", "mass"), 1u);
  EXPECT_EQ(edits("amss", "mass"), 1u);
  EXPECT_EQ(edits("kitten", "sitting"), 3u);
  EXPECT_EQ(edits("damping", "stiffness"), edits("stiffness", "damping"));
}

TEST(Spelling, KnowsWhatIsMisspeltFromWhatIsAnotherWord) {
  EXPECT_TRUE(looks_like("untis", "units"));
  EXPECT_TRUE(looks_like("voxelsize", "voxel_size"));
  EXPECT_TRUE(looks_like("qaternoin", "quaternion"));
  EXPECT_FALSE(looks_like("rate", "unit"));
  EXPECT_FALSE(looks_like("damping", "stiffness"));
  EXPECT_FALSE(looks_like(std::string(1000, 'x'), "mass"));
}

}  // namespace
}  // namespace ist::test
