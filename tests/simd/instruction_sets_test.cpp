// Tests that have an instruction set as their parameter run for those that are here. The others are
// skipped by name here, so that no one takes their absence for a pass.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "simd/targets.h"

namespace ist::test {
namespace {

std::vector<std::string> targets_of_platform() {
#if defined(__x86_64__)
  return {"avx3", "avx2", "sse4", "ssse3", "scalar"};
#elif defined(__aarch64__)
  return {"neon", "scalar"};
#else
  return {"scalar"};
#endif
}

class InstructionSet : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Targets, InstructionSet, ::testing::ValuesIn(targets_of_platform()),
                         name_of);

TEST_P(InstructionSet, IsHereToBeTested) {
  const std::vector<std::string> here = all_targets();
  if (std::find(here.begin(), here.end(), GetParam()) == here.end())
    GTEST_SKIP() << "this processor, or this build, has no " << GetParam()
                 << ": no test of it is run";
}

TEST(InstructionSets, AreThoseOfThePlatform) {
  const std::vector<std::string> known = targets_of_platform();
  for (const std::string& target : all_targets())
    EXPECT_NE(std::find(known.begin(), known.end(), target), known.end()) << target;
}

}  // namespace
}  // namespace ist::test
