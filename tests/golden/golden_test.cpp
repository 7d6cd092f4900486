// The same bits by every build, every instruction set and every platform.
//
//   golden_test            compares each kind of answers with its golden hash
//   golden_test --hashes   prints "target<tab>answers<tab>hash" of each instead, and of all
//   together

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <string>
#include <tuple>

#include "golden/answers.h"
#include "golden/hasher.h"
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
  const auto print = [](const std::string& target, const char* name, std::uint64_t hash) {
    std::printf("%s\t%s\t%016llx\n", target.c_str(), name, static_cast<unsigned long long>(hash));
  };
  for (const std::string& target : all_targets()) {
    Hasher all;
    for (const GoldenAnswers& kind : golden_answers()) {
      const std::uint64_t hash = kind.hash(target);
      all.add(hash);
      print(target, kind.name, hash);
    }
    print(target, "all", all.value());
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
