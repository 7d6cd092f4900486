#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "simd/guarded.h"
#include "simd/lanes.h"
#include "simd/plan_cases.h"
#include "simd/targets.h"
#include "support/effort.h"

namespace ist::test {
namespace {

// Each vector kernel against the scalar form, which specifies it.
class Advance : public ::testing::TestWithParam<std::string> {
 protected:
  // Both go through `in` in frontiers of `room`, in calls of at most `most` tests, from the same
  // places on to the same places. Returns how many pairs they found.
  std::size_t expect_same(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                          std::size_t room, std::size_t offset,
                          std::uint64_t most = ~std::uint64_t{0}) {
    std::size_t found = 0;
    for (const Measured measured : {Measured::kNothing, Measured::kUpper, Measured::kBoth}) {
      GuardedFrontier wanted(room, 0), made(room, offset);
      SearchCursor wanted_cursor, made_cursor;
      DistanceBounds wanted_bounds, made_bounds;
      found = 0;
      while (wanted_cursor.group < in.group_count) {
        wanted.clear();
        made.clear();
        Advanced of_wanted, of_made;
        do {
          of_wanted = advance_scalar(step, pose, in, wanted_cursor, wanted, *scratch_, most,
                                     measured, wanted_bounds);
          of_made = kernels_.advance(step, pose, in, made_cursor, made, *scratch_, most, measured,
                                     made_bounds);
          EXPECT_EQ(of_made.tests, of_wanted.tests);
          EXPECT_EQ(of_made.full, of_wanted.full);
          EXPECT_LE(of_wanted.tests, most);
          EXPECT_EQ(made_cursor, wanted_cursor);
          EXPECT_EQ(made_bounds.lower, wanted_bounds.lower);
          EXPECT_EQ(made_bounds.upper, wanted_bounds.upper);
          if (HasFailure()) return found;
        } while (of_wanted.tests > 0 && !of_wanted.full && wanted_cursor.group < in.group_count);
        EXPECT_TRUE(same_pairs(made, wanted));
        EXPECT_TRUE(made.intact());
        EXPECT_TRUE(wanted.intact());
        if (HasFailure()) return found;
        found += wanted.moving_count;
      }
    }
    return found;
  }

  const Kernels& kernels_ = select_kernels(GetParam());
  const std::unique_ptr<SearchScratch> scratch_ = std::make_unique<SearchScratch>();
};

INSTANTIATE_TEST_SUITE_P(Targets, Advance, ::testing::ValuesIn(vector_targets()), name_of);

std::vector<std::uint32_t> some_of(std::vector<std::uint32_t> names, std::size_t count,
                                   Random& random) {
  for (std::size_t i = 0; i + 1 < names.size(); ++i) {
    std::swap(names[i], names[i + random.below(names.size() - i)]);
  }
  names.resize(std::min(count, names.size()));
  std::sort(names.begin(), names.end());
  return names;
}

// Groups of every length up to 70, and some that no scratch memory holds.
TEST_P(Advance, IsTheScalarFormForGroupsOfAnyLength) {
  std::size_t found = 0, tested = 0, longest = 0;
  Random random(1);
  for (const auto& search : all_plans()) {
    for (std::size_t step = 0; step < search->plan.steps().size(); ++step) {
      const PlannedSearch::Names& names = search->names[step];
      GuardedFrontier in(1 << 13, random.below(16));
      std::size_t most = 0;
      for (std::size_t length = 0; length <= 73; ++length) {
        const std::vector<std::uint32_t> moving =
            some_of(names.moving, length <= 70 ? length : 60 * (length - 68), random);
        in.append(names.fixed[random.below(names.fixed.size())], moving);
        most = std::max(most, moving.size());
      }
      const std::size_t all = 64 * in.moving_count;
      for (const std::size_t room : {all, 8 * most, 8 * most + 100}) {
        SCOPED_TRACE(std::string(to_string(search->policy)) + ", step " + std::to_string(step) +
                     ", room for " + std::to_string(room));
        found += expect_same(search->plan.steps()[step], random_pose(random, 0.5), in, room,
                             random.below(16));
        if (HasFailure()) return;
      }
      tested += 3 * all;
      longest = std::max(longest, most);
    }
  }
  EXPECT_GT(longest, 128u);
  EXPECT_GT(found, tested / 100);
  EXPECT_LT(found, tested / 4);
}

// The pairs that a search meets, from the roots down. Each step takes the pairs that the step
// before left.
TEST_P(Advance, IsTheScalarFormAllTheWayDown) {
  std::size_t leaves = 0;
  Random random(2);
  for (const auto& search : all_plans()) {
    for (std::size_t i = 0; i < samples(std::size_t{4}); ++i) {
      const SearchPose pose = random_pose(random, 0.01);
      auto in = std::make_unique<GuardedFrontier>(1, 0);
      in->append(0, std::vector<std::uint32_t>{0});
      for (std::size_t step = 0; step < search->plan.steps().size(); ++step) {
        SCOPED_TRACE(std::string(to_string(search->policy)) + ", step " + std::to_string(step));
        const SearchStep& by = search->plan.steps()[step];
        const std::size_t row = search->plan.longest_row(step);
        expect_same(by, pose, *in, row, i % 16);
        expect_same(by, pose, *in, 8 * row, i % 16, kPieceTests + random.below(500));
        auto out = std::make_unique<GuardedFrontier>(search->plan.most_pairs(step), 0);
        SearchCursor cursor;
        DistanceBounds none;
        advance_scalar(by, pose, *in, cursor, *out, *scratch_, ~std::uint64_t{0},
                       Measured::kNothing, none);
        in = std::move(out);
        if (HasFailure()) return;
      }
      leaves += in->moving_count;
    }
  }
  EXPECT_GT(leaves, samples(std::size_t{3'000}));
}

TEST_P(Advance, WritesLeafPairsOfGroupsOfAnyLength) {
  Random random(3);
  for (std::size_t length = 0; length <= 65; ++length) {
    for (std::size_t groups = 0; groups <= 4; ++groups) {
      GuardedFrontier leaves(4 * 70, random.below(16));
      for (std::size_t g = 0; g < groups; ++g) {
        std::vector<std::uint32_t> moving(g % 2 == 0 ? length : 1 + random.below(9));
        for (std::uint32_t& m : moving) m = static_cast<std::uint32_t>(random.below(1ULL << 32));
        leaves.append(static_cast<std::uint32_t>(random.below(1ULL << 32)), moving);
      }
      std::vector<LeafPair> wanted(leaves.moving_count);
      write_leaf_pairs_scalar(leaves, wanted.data());
      Guarded<LeafPair> made(leaves.moving_count + kLeafPairSpare, random.below(8));
      kernels_.write_leaf_pairs(leaves, made.data());
      ASSERT_TRUE(std::equal(wanted.begin(), wanted.end(), made.data()));
      ASSERT_TRUE(made.intact()) << length << " contacts in a group";
    }
  }
}

// The scalar form, by hand.
TEST(WriteLeafPairs, PairsEachGroupWithItsNodes) {
  GuardedFrontier leaves(16, 0);
  leaves.append(7, std::vector<std::uint32_t>{1, 2});
  leaves.append(9, std::vector<std::uint32_t>{2});
  std::vector<LeafPair> made(3);
  write_leaf_pairs_scalar(leaves, made.data());
  EXPECT_EQ(made, (std::vector<LeafPair>{{7, 1}, {7, 2}, {9, 2}}));
}

}  // namespace
}  // namespace ist::test
