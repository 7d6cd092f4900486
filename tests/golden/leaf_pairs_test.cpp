#include <gtest/gtest.h>

#include <array>

#include "golden/hasher.h"
#include "query/scenes.h"
#include "simd/targets.h"

namespace ist::test {
namespace {

// By policy.
using Hashes = std::array<std::uint64_t, 4>;
constexpr Hashes kGoldenJaws = {0x84188b65e9d43672, 0xba6c1db36d1f2b1a, 0x6255484a34863d2f,
                                0xf20f8d7acc2a2038};
constexpr Hashes kGoldenSolids[3] = {
    {
        0x1d333c6a0c3550e7,
        0x8fcd6e73e17653e9,
        0xdb5145f02d8d2e6e,
        0x9b089d7da09f2978,
    },
    {
        0x91e1c3add1ddd5e9,
        0x00b0a29b3dd5849c,
        0xc940ca98685ae848,
        0x1f365a334ebe0f6a,
    },
    {
        0x8ca386835396f93c,
        0x340be4a0ba779514,
        0xc38b63ee2aab44ba,
        0xeb7c473aa8d81539,
    },
};

std::uint64_t hash_of(const FoundPairs& answer) {
  const std::array<std::uint64_t, 3> numbers = {
      answer.result.leaf_pairs, answer.result.sphere_tests,
      XXH3_64bits(answer.leaf_pairs.data(), answer.leaf_pairs.size() * sizeof(LeafPair))};
  return XXH3_64bits(numbers.data(), sizeof(numbers));
}

// One answer for every instruction set, for one worker and for two, in every build, always.
class GoldenLeafPairs : public ::testing::TestWithParam<std::string> {
 protected:
  static void expect(const Scene& scene, const Hashes& golden) {
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const int workers : {1, 2}) {
        Query query(scene.fixed, scene.moving, options_of(policy, GetParam(), workers));
        FoundPairs answer = ask(query, scene.pose);
        const int repeats = query.workers() == 2 ? 25 : 1;  // a worker may come in at any time
        for (int repeat = 0; repeat < repeats; ++repeat) {
          answer.result = query.leaf_pairs(scene.pose, answer.leaf_pairs);
          const std::uint64_t hash = hash_of(answer);
          ASSERT_EQ(hash, golden[static_cast<std::size_t>(policy)])
              << scene.name << ", " << to_string(policy) << ", " << workers << " workers, repeat "
              << repeat << ": 0x" << std::hex << hash;
        }
      }
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Golden, GoldenLeafPairs, ::testing::ValuesIn(all_targets()), name_of);

TEST_P(GoldenLeafPairs, OfJawsHaveTheSameBytesEverywhere) { expect(jaws(), kGoldenJaws); }

TEST_P(GoldenLeafPairs, OfSolidsHaveTheSameBytesEverywhere) {
  ASSERT_EQ(solids().size(), std::size(kGoldenSolids));
  for (std::size_t i = 0; i < solids().size(); ++i) expect(solids()[i], kGoldenSolids[i]);
}

}  // namespace
}  // namespace ist::test
