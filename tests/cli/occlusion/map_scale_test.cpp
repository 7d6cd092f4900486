#include "answers/occlusion/map_scale.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cli/occlusion/bites.h"

namespace ist::test {
namespace {

using answers::Colour, answers::kBareSurface, answers::MapScale;

TEST(MapScale, OfDistances_IsContinuousButAtZero) {
  const MapScale scale = MapScale::of_distances(-0.5, 1);
  EXPECT_EQ(scale.colour(-0.5), (Colour{104, 28, 132}));
  EXPECT_EQ(scale.colour(-9), scale.colour(-0.5)) << "deeper than the range";
  EXPECT_EQ(scale.colour(1), (Colour{56, 104, 184}));
  EXPECT_EQ(scale.colour(1.001), kBareSurface);
  EXPECT_EQ(scale.colour(std::nan("")), kBareSurface);
  for (double at = -0.5; at < 0.999; at += 0.001) {
    if (at <= 0 && at + 0.001 > 0) continue;
    const Colour one = scale.colour(at), other = scale.colour(at + 0.001);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(std::abs(one[i] - other[i]), 2) << at;
  }
  EXPECT_TRUE(scale.bands().empty());
  EXPECT_FALSE(scale.is_hatched(-0.01));
}

TEST(MapScale, OfDistancesAbove0_BeginsRed) {
  const MapScale scale = MapScale::of_distances(0.1, 0.5);
  EXPECT_EQ(scale.colour(0.1), (Colour{196, 54, 22}));
  EXPECT_EQ(scale.colour(-1), scale.colour(0.1));
}

TEST(MapScale, OfChanges_IsWhiteAtZeroAndRedIfNearer) {
  const MapScale scale = MapScale::of_changes(0.2);
  EXPECT_EQ(scale.colour(0), (Colour{247, 247, 247}));
  EXPECT_GT(scale.colour(-0.2)[0], scale.colour(-0.2)[2]);
  EXPECT_LT(scale.colour(0.2)[0], scale.colour(0.2)[2]);
  EXPECT_EQ(scale.colour(7), scale.colour(0.2));
  EXPECT_EQ(scale.colour(-7), scale.colour(-0.2));
}

TEST(MapScale, OfBands_HasTheirColours) {
  const auto made = sphere_over_plate({0, 0, -0.1});
  const auto bands = answers::map_bands(made->bite);
  const MapScale scale = MapScale::of_bands(bands);
  for (const double at : {-1.0, -0.06, -0.02, 0.05, 0.5, 3.0}) {
    EXPECT_EQ(scale.colour(at), answers::map_colour(at, bands)) << at;
  }
  EXPECT_TRUE(scale.is_hatched(-0.02));
  EXPECT_FALSE(scale.is_hatched(-0.06));
}

TEST(RoundStep, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(answers::round_step(1), 1);
  EXPECT_DOUBLE_EQ(answers::round_step(1.9), 1);
  EXPECT_DOUBLE_EQ(answers::round_step(49), 20);
  EXPECT_DOUBLE_EQ(answers::round_step(0.07), 0.05);
}

}  // namespace
}  // namespace ist::test
