#include "ist/query/query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "ist/base/error.h"
#include "ist/query/workers/shared_work.h"
#include "ist/tree/sphere_tree.h"
#include "query/scenes.h"
#include "simd/guarded.h"
#include "simd/targets.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// Every target with every policy.
class QueryTest : public ::testing::TestWithParam<std::string> {
 protected:
  template <class Check>
  void for_each_policy(int workers, const Check& check) const {
    for (const SpherePolicy policy : kSpherePolicies) {
      SCOPED_TRACE(to_string(policy));
      Query query(scene_.fixed, scene_.moving, options_of(policy, GetParam(), workers));
      check(query);
    }
  }
  const Scene& scene_ = solids()[0];
};

INSTANTIATE_TEST_SUITE_P(Targets, QueryTest, ::testing::ValuesIn(all_targets()), name_of);

TEST_P(QueryTest, SaysWhatItWasMadeOf) {
  for_each_policy(1, [](const Query& query) {
    EXPECT_EQ(query.target(), GetParam());
    EXPECT_EQ(query.workers(), 1);
    EXPECT_EQ(sharing_of(query).chunks, 0u);
  });
  for_each_policy(2, [](const Query& query) { EXPECT_EQ(query.workers(), 2); });
}

TEST(Query, TakesTheTightestPolicyThatBothTreesHave) {
  const auto tree = [](SpherePolicy spheres) {
    BuildOptions options;
    options.voxel_size = 0.5;
    options.spheres = spheres;
    return build_tree(icosphere(1, 1), options);
  };
  const SphereTree table = tree(SpherePolicy::kTable), tight = tree(SpherePolicy::kTight),
                   slab = tree(SpherePolicy::kSlab);
  EXPECT_EQ(Query(slab, slab).policy(), SpherePolicy::kSlab);
  EXPECT_EQ(Query(slab, tight).policy(), SpherePolicy::kTight);
  EXPECT_EQ(Query(table, slab).policy(), SpherePolicy::kTable);
  EXPECT_EQ(error_name([&] { Query(slab, tight, options_of(SpherePolicy::kSlab)); }),
            to_string(ErrorCode::kPolicyMissing));
  EXPECT_EQ(error_name([&] { Query(slab, slab, options_of(SpherePolicy::kSlab, "abacus")); }),
            to_string(ErrorCode::kTargetMissing));
}

// Takes pairs until it has enough.
struct Taken final : LeafPairStream {
  explicit Taken(std::size_t wanted) : enough(wanted) {}
  bool take(std::span<const LeafPair> some) noexcept override {
    EXPECT_LT(leaf_pairs.size(), enough);  // never asked again
    leaf_pairs.insert(leaf_pairs.end(), some.begin(), some.end());
    return leaf_pairs.size() < enough;
  }
  std::size_t enough;
  std::vector<LeafPair> leaf_pairs;
};

TEST_P(QueryTest, AStreamGetsAllContactsInOrderUntilItHasEnough) {
  for (const Scene& scene : {std::cref(scene_), std::cref(shells())}) {
    for (const int workers : {1, 2}) {
      for (const std::size_t pairs : {65536u, 100u}) {
        QueryOptions options = options_of(SpherePolicy::kSlab, GetParam(), workers);
        options.frontier_pairs = pairs;
        Query query(scene.fixed, scene.moving, options);
        const FoundPairs all = ask(query, scene.pose);
        Taken everything(all.leaf_pairs.size() + 1);
        const QueryResult result = query.leaf_pairs(scene.pose, everything);
        EXPECT_EQ(everything.leaf_pairs, all.leaf_pairs);
        EXPECT_EQ(result.leaf_pairs, all.leaf_pairs.size());
        EXPECT_EQ(result.sphere_tests, all.result.sphere_tests);
        EXPECT_FALSE(result.truncated);
        EXPECT_TRUE(result.complete);
        Taken some(10);
        const QueryResult part = query.leaf_pairs(scene.pose, some);
        EXPECT_FALSE(part.complete);
        EXPECT_EQ(part.leaf_pairs, some.leaf_pairs.size());
        ASSERT_GE(some.leaf_pairs.size(), 10u);
        // One frontier of leaves holds all of them, or a part.
        if (pairs == 100) {
          EXPECT_LT(some.leaf_pairs.size(), all.leaf_pairs.size());
        }
        EXPECT_TRUE(
            std::equal(some.leaf_pairs.begin(), some.leaf_pairs.end(), all.leaf_pairs.begin()));
      }
    }
  }
}

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
