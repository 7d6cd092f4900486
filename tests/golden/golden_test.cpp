// The same bits by every build, every instruction set and every platform.
//
//   golden_test            compares each kind of answers with its golden hash
//   golden_test --hashes   prints "target<tab>answers<tab>hash" of each instead

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <string>
#include <tuple>

#include "golden/answers.h"
#include "simd/targets.h"

namespace ist::test {
namespace {

class Golden : public ::testing::TestWithParam<std::tuple<std::size_t, std::string>> {};

std::string name_of_answers(const ::testing::TestParamInfo<Golden::ParamType>& info) {
  std::string name = golden_answers()[std::get<0>(info.param)].name;
  for (char& c : name) c = c == ' ' ? '_' : c;
  return name + "_" + std::get<1>(info.param);
}

INSTANTIATE_TEST_SUITE_P(Answers, Golden,
                         ::testing::Combine(::testing::Range(std::size_t{0},
                                                             golden_answers().size()),
                                            ::testing::ValuesIn(all_targets())),
                         name_of_answers);

TEST_P(Golden, AnswersHaveTheSameBitsEverywhere) {
  const auto& [answers, target] = GetParam();
  const GoldenAnswers& kind = golden_answers()[answers];
  EXPECT_EQ(kind.hash(target), kind.golden) << kind.name << " by " << target;
}

void print_hashes() {
  for (const std::string& target : all_targets()) {
    for (const GoldenAnswers& kind : golden_answers()) {
      std::printf("%s\t%s\t%016llx\n", target.c_str(), kind.name,
                  static_cast<unsigned long long>(kind.hash(target)));
    }
  }
}

}  // namespace
}  // namespace ist::test

int main(int count, char** arguments) {
  if (count == 2 && std::strcmp(arguments[1], "--hashes") == 0) {
    ist::test::print_hashes();
    return 0;
  }
  ::testing::InitGoogleTest(&count, arguments);
  return RUN_ALL_TESTS();
}
