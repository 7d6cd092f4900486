#include <gtest/gtest.h>
#include <xxhash.h>

#include <array>

#include "query/search/scenes.h"
#include "query/search/targets.h"

namespace ist::test {
namespace {

// By scene and policy.
constexpr std::uint64_t kGolden[4][4] = {
    {
        0x9b68127037f06f96,
        0x18c7e1cd83cf7b99,
        0xcf9ee847f3591b44,
        0x8adeaedf99ab487e,
    },
    {
        0x1d333c6a0c3550e7,
        0x2273845ef4955865,
        0x5bceb196845ba30e,
        0xa8ec4b7c0a60d678,
    },
    {
        0x91e1c3add1ddd5e9,
        0x2e9d355d9b6fc12a,
        0xb3b77ace34ae806d,
        0xe5f7e5b7aafdc9d9,
    },
    {
        0x8ca386835396f93c,
        0x150c26b0ad4b90a5,
        0x43f689f384faabe2,
        0xec43dd9d31435a78,
    },
};

std::uint64_t hash_of(const Answer& answer) {
  const std::array<std::uint64_t, 3> numbers = {
      answer.result.contacts, answer.result.sphere_tests,
      XXH3_64bits(answer.contacts.data(), answer.contacts.size() * sizeof(Contact))};
  return XXH3_64bits(numbers.data(), sizeof(numbers));
}

// One answer for every instruction set, for one worker and for two, in every build, always.
class Golden : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Targets, Golden, ::testing::ValuesIn(all_targets()), name_of);

TEST_P(Golden, AnswersAreTheSameBytesEverywhere) {
  ASSERT_EQ(scenes().size(), std::size(kGolden));
  for (std::size_t i = 0; i < std::size(kGolden); ++i) {
    for (const SpherePolicy policy : kSpherePolicies) {
      const Scene& scene = scenes()[i];
      for (const int workers : {1, 2}) {
        CollisionQuery query(scene.fixed, scene.moving, options_of(policy, GetParam(), workers));
        Answer answer = ask(query, scene.pose);
        for (int repeat = 0; repeat < 250; ++repeat) {
          answer.result = query.collide(scene.pose, answer.contacts);
          const std::uint64_t hash = hash_of(answer);
          ASSERT_EQ(hash, kGolden[i][static_cast<std::size_t>(policy)])
              << scene.name << ", " << to_string(policy) << ", " << workers << " workers, repeat "
              << repeat << ": 0x" << std::hex << hash;
        }
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
