#include <gtest/gtest.h>

#include <algorithm>

#include "query/scenes.h"
#include "simd/guarded.h"
#include "simd/targets.h"

namespace ist::test {
namespace {

class Memory : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Targets, Memory, ::testing::ValuesIn(all_targets()), name_of);

// However often the frontiers are full and cut.
TEST_P(Memory, OfAnySizeGivesTheSameAnswer) {
  for (const Scene& scene : solids()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      QueryOptions options = options_of(policy, "scalar");
      Query unbounded(scene.fixed, scene.moving, options);
      const FoundPairs expected = ask(unbounded, scene.pose);
      ASSERT_GT(expected.leaf_pairs.size(), 200u);
      std::size_t bytes = unbounded.bytes();
      options.target = GetParam();
      for (const std::size_t pairs : {65536u, 1000u, 64u, 7u, 2u, 1u}) {
        options.frontier_pairs = pairs;
        Query query(scene.fixed, scene.moving, options);
        EXPECT_TRUE(same(ask(query, scene.pose), expected))
            << scene.name << ", " << to_string(policy) << ", " << pairs << " pairs";
        EXPECT_LE(query.bytes(), bytes);
        bytes = query.bytes();
      }
    }
  }
}

// Spans of every length up to some hundreds, and about the number of contacts.
TEST_P(Memory, TooShortForAllContactsHoldsTheFirst) {
  for (const Scene& scene : solids()) {
    for (const std::size_t pairs : {65536u, 7u}) {
      QueryOptions options = options_of(SpherePolicy::kSlab, GetParam());
      options.frontier_pairs = pairs;
      Query query(scene.fixed, scene.moving, options);
      const FoundPairs all = ask(query, scene.pose);
      const std::size_t count = all.leaf_pairs.size();
      std::size_t length = 0;
      while (length <= count + 20) {
        Guarded<LeafPair> out(length, length % 8);
        const QueryResult result = query.leaf_pairs(scene.pose, out.span());
        ASSERT_EQ(result.leaf_pairs, count);
        ASSERT_EQ(result.truncated, length < count);
        ASSERT_EQ(result.sphere_tests, all.result.sphere_tests);
        ASSERT_TRUE(std::equal(
            all.leaf_pairs.begin(),
            all.leaf_pairs.begin() + static_cast<std::ptrdiff_t>(std::min(length, count)),
            out.data()))
            << scene.name << ", room for " << length << " of " << count;
        ASSERT_TRUE(out.intact()) << scene.name << ", room for " << length << " of " << count;
        length += length < 100 || length + 40 > count
                      ? 1
                      : std::min<std::size_t>(37, count - 40 - length + 1);
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
