#include "hardware/golden_vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <set>
#include <utility>

#include "ist/hardware/table_rom.h"

namespace ist::test {
namespace {

int cut_of(std::uint64_t reach) {
  return std::max(0, static_cast<int>(std::bit_width(reach)) - 15);
}

TEST(GoldenVectors, CornerCasesComeFirstWhateverTheSeed) {
  const std::vector<GoldenVector> corners = corner_cases();
  GoldenVectors one(1), again(1), other(2);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EXPECT_EQ(one.next(), corners[i]) << i;
    EXPECT_EQ(other.next(), corners[i]) << i;
    static_cast<void>(again.next());
  }
  int differ = 0;
  for (int i = 0; i < 100; ++i) {
    const GoldenVector vector = one.next();
    EXPECT_EQ(vector, again.next()) << i;
    differ += vector == other.next() ? 0 : 1;
  }
  EXPECT_EQ(differ, 100);
}

TEST(GoldenVectors, CornersGoToTheEndsOfEveryInput) {
  std::set<int> fixed_masks, moving_masks, fixed_levels, moving_levels;
  std::set<std::int32_t> fixed_centres, moving_centres, rotations;
  std::set<int> pads, radii;
  for (const auto& [pair, registers, answer] : corner_cases()) {
    fixed_masks.insert(pair.fixed_mask);
    moving_masks.insert(pair.moving_mask);
    fixed_levels.insert(pair.fixed_level);
    moving_levels.insert(pair.moving_level);
    fixed_centres.insert(pair.fixed_centre.begin(), pair.fixed_centre.end());
    moving_centres.insert(pair.moving_centre.begin(), pair.moving_centre.end());
    if (registers.rotation == std::array<std::int32_t, 9>{} || registers.rotation[1] != 0) {
      rotations.insert(registers.rotation.begin(), registers.rotation.end());
    }
    pads.insert(registers.pad);
    radii.insert(registers.radius.begin(), registers.radius.end());
    EXPECT_TRUE(!answer.hit || (pair.fixed_mask != 0 && pair.moving_mask != 0));
  }
  EXPECT_EQ(fixed_masks.size(), 256u);
  EXPECT_EQ(moving_masks.size(), 256u);
  for (const auto& levels : {fixed_levels, moving_levels}) {
    EXPECT_EQ(*levels.begin(), 0);
    EXPECT_EQ(*levels.rbegin(), kMaxNodeLevel);
  }
  EXPECT_EQ(*fixed_centres.begin(), -kMaxCentre);
  EXPECT_EQ(*fixed_centres.rbegin(), kMaxCentre);
  EXPECT_EQ(*moving_centres.begin(), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(*moving_centres.rbegin(), std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(*rotations.begin(), -(1 << 19));
  EXPECT_EQ(*rotations.rbegin(), (1 << 19) - 1);
  for (const auto& numbers : {pads, radii}) {
    EXPECT_EQ(*numbers.begin(), 0);
    EXPECT_EQ(*numbers.rbegin(), 0xFFFF);
  }
}

// On each axis, to both sides: touching to the last bit is a hit, one step more is a miss. And with
// every number of bits that is cut off the reach.
TEST(GoldenVectors, CornersTouchToTheLastBit) {
  std::set<std::pair<std::size_t, bool>> touching, beyond;
  std::set<int> cuts_touching, cuts_beyond, cuts_equal, cuts_just_more;
  for (const auto& [pair, registers, answer] : corner_cases()) {
    if (pair.fixed_mask == 0 || pair.moving_mask == 0) continue;
    const auto distance = ball_distance(pair, registers);
    const auto reach = static_cast<std::int64_t>(answer.reach);
    const int cut = cut_of(answer.reach);
    std::int64_t squared = 0;
    std::size_t zeros = 0, axis = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t n = std::abs(distance[i]) >> cut;
      squared += n * n;
      zeros += distance[i] == 0 ? 1u : 0u;
      if (distance[i] != 0) axis = i;
    }
    if (zeros == 2 && std::abs(distance[axis]) == reach) {
      EXPECT_TRUE(answer.hit);
      touching.insert({axis, distance[axis] > 0});
      cuts_touching.insert(cut);
    } else if (zeros == 2 && std::abs(distance[axis]) == reach + 1) {
      EXPECT_FALSE(answer.hit);
      beyond.insert({axis, distance[axis] > 0});
      cuts_beyond.insert(cut);
    } else if (zeros == 0) {
      const std::int64_t longest = (reach + (std::int64_t{1} << cut) - 1) >> cut;
      if (squared == longest * longest) cuts_equal.insert(cut);
      if (squared > longest * longest && squared <= (longest + 1) * (longest + 1)) {
        EXPECT_FALSE(answer.hit);
        cuts_just_more.insert(cut);
      }
    }
  }
  EXPECT_EQ(touching.size(), 6u);
  EXPECT_EQ(beyond.size(), 6u);
  for (int cut = 0; cut <= 16; ++cut) {
    EXPECT_EQ(cuts_touching.count(cut), 1u) << cut;
    EXPECT_EQ(cuts_beyond.count(cut), 1u) << cut;
    EXPECT_EQ(cuts_equal.count(cut), 1u) << cut;
    EXPECT_EQ(cuts_just_more.count(cut), 1u) << cut;
  }
}

// Half of the random vectors are near contact, and neither answer is rare.
TEST(GoldenVectors, RandomOnesAreBalanced) {
  GoldenVectors vectors(3);
  const std::size_t corners = corner_cases().size();
  for (std::size_t i = 0; i < corners; ++i) static_cast<void>(vectors.next());
  int hits = 0, near = 0;
  constexpr int kAsked = 20'000;
  for (int i = 0; i < kAsked; ++i) {
    const auto [pair, registers, answer] = vectors.next();
    ASSERT_LE(pair.fixed_level, kMaxNodeLevel);
    ASSERT_LE(pair.moving_level, kMaxNodeLevel);
    double squared = 0;
    for (const std::int64_t d : ball_distance(pair, registers)) {
      squared += static_cast<double>(d) * static_cast<double>(d);
    }
    const auto reach = static_cast<double>(answer.reach);
    near += std::abs(squared / (reach * reach) - 1) < 0.1 ? 1 : 0;
    hits += answer.hit ? 1 : 0;
  }
  EXPECT_GT(hits, kAsked * 2 / 5);
  EXPECT_LT(hits, kAsked * 3 / 5);
  EXPECT_GT(near, kAsked * 2 / 5);
}

}  // namespace
}  // namespace ist::test
