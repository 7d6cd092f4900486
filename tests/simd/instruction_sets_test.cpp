// Tests that have an instruction set as their parameter run for those that are here. The others are
// skipped by name here, so that no one takes their absence for a pass.

#include "ist/base/platform/instruction_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <set>
#include <sstream>
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

#if defined(__x86_64__)
// By the system's own list, which it makes of what the processor says and of what it saves.
TEST(InstructionSets, AreThoseThatTheSystemNames) {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  std::set<std::string> flags;
  while (flags.empty() && std::getline(file, line)) {
    std::istringstream words(line);
    if (line.rfind("flags", 0) == 0) flags.insert(std::istream_iterator<std::string>(words), {});
  }
  ASSERT_TRUE(flags.contains("sse2"));
  const auto all = [&](std::initializer_list<const char*> names) {
    return std::all_of(names.begin(), names.end(), [&](auto name) { return flags.contains(name); });
  };
  const InstructionSets here = instruction_sets();
  EXPECT_EQ(here.ssse3, all({"ssse3"}));
  EXPECT_EQ(here.sse4, here.ssse3 && all({"sse4_1", "sse4_2", "aes", "pclmulqdq"}));
  EXPECT_EQ(here.avx2, here.sse4 && all({"avx", "avx2", "bmi1", "bmi2", "fma", "f16c"}));
  EXPECT_EQ(here.avx3, here.avx2 && all({"avx512f", "avx512vl", "avx512dq", "avx512bw"}));
  for (const std::string& target : all_targets()) {
    EXPECT_TRUE(target == "scalar" || (target == "ssse3" && here.ssse3) ||
                (target == "sse4" && here.sse4) || (target == "avx2" && here.avx2) ||
                (target == "avx3" && here.avx3))
        << target;
  }
}
#endif

}  // namespace
}  // namespace ist::test
