#include "ist/tree/node_bounds.h"

#include <gtest/gtest.h>

#include "support/effort.h"
#include "support/random.h"

namespace ist {
namespace {

using Eigen::Vector3d;

// In a parent's cube of edge 2 round the origin; a child's has edge 1.
constexpr double kUnit = 0x1p-15, kSlabUnit = 0x1p-8;

Payload payload(std::vector<Vector3d> points, const Vector3d& area = {0, 0, 0}) {
  return {std::move(points), area, 0x1p-48};
}

PackedBall ball_of(const Payload& payload) { return pack_ball(payload, {0, 0, 0}, 2); }

TEST(PackBall, OfAPointOnItsLatticeIsOneUnit) {
  EXPECT_EQ(ball_of(payload({{0, 0, 0}})), (PackedBall{0, 0, 0, 1}));
  EXPECT_EQ(ball_of(payload({{-1, -1, -1}})), (PackedBall{-32768, -32768, -32768, 1}));
  EXPECT_EQ(ball_of(payload({{0.5, -0.25, kUnit}})), (PackedBall{16384, -8192, 1, 1}));
}

TEST(PackBall, RoundsTheCentreToTheNearestUnitAndTheRadiusUp) {
  EXPECT_EQ(ball_of(payload({{3.4 * kUnit, 3.6 * kUnit, -3.6 * kUnit}})),
            (PackedBall{3, 4, -4, 1}));
  EXPECT_EQ(ball_of(payload({{-0.5, 0, 0}, {0.5, 0, 0}})), (PackedBall{0, 0, 0, 16385}));
}

// The far faces of the parent's cube are one unit beyond what a block can hold.
TEST(PackBall, HoldsWhatLiesBeyondTheLastCentre) {
  EXPECT_EQ(ball_of(payload({{1, 1, 1}})), (PackedBall{32767, 32767, 32767, 2}));
  EXPECT_EQ(ball_of(payload({{1 + 2 * kUnit, 0, 0}})), (PackedBall{32767, 0, 0, 4}));
  EXPECT_EQ(ball_of(payload({{1, -1, 0}, {1, 0, 0}})), (PackedBall{32767, -16384, 0, 16385}));
}

TEST(PackBall, HasItsCentreInTheParentsCube) {
  const PackedBall ball = pack_ball(payload({{3, 4, 5}}), {3.5, 3.5, 4.5}, 2);
  EXPECT_EQ(ball, (PackedBall{-16384, 16384, 16384, 1}));
  EXPECT_EQ(centre_of(ball, {3.5, 3.5, 4.5}, 2), Vector3d(3, 4, 5));
}

TEST(PackSlab, OfAPlaneIsOneUnit) {
  const Payload square = payload({{0, 0, 0.25}, {1, 0, 0.25}, {1, 1, 0.25}, {0, 1, 0.25}});
  const PackedSlab slab = pack_slab(square, {0.5, 0.5, 0.25}, 1);
  EXPECT_EQ(std::abs(slab.nz), 126);
  EXPECT_EQ(slab, (PackedSlab{0, 0, slab.nz, 0, 1}));
}

// A normal is rounded by up to half a degree: the slab of a large plane across is a little thicker.
TEST(PackSlab, OfAPlaneAcrossIsAFewUnits) {
  test::Random random(1);
  for (int i = 0; i < test::samples(100); ++i) {
    const Vector3d u = 0.3 * random.direction(), v = 0.3 * random.direction();
    const PackedSlab slab = pack_slab(payload({-u, u, -v, v}), {0, 0, 0}, 1);
    EXPECT_LE(slab.half, 3);
  }
}

// Many points on four edges, and one off them: it spreads little, and yet it makes a thick slab.
TEST(PackSlab, TakesTheThinnerOfTwoAxes) {
  std::vector<Vector3d> points{{0, 0.2, 0}};
  for (int i = 0; i < 80; ++i) {
    points.emplace_back((i & 1) != 0 ? 0.3 : -0.3, 0, (i & 2) != 0 ? 0.05 : -0.05);
  }
  const Vector3d centre(0, 0.05, 0);
  const PackedSlab by_spread = pack_slab(payload(points), centre, 1);
  EXPECT_EQ(std::abs(by_spread.ny), 126);
  EXPECT_NEAR(by_spread.half * kSlabUnit, 0.1, 0.01);
  const PackedSlab by_area = pack_slab(payload(points, {0, 0, 1e-9}), centre, 1);
  EXPECT_EQ(by_area.nz, 126);
  EXPECT_NEAR(by_area.half * kSlabUnit, 0.05, 0.01);
  EXPECT_EQ(pack_slab(payload(points, {2, 0, 0}), centre, 1), by_spread);
}

TEST(PackSlab, HasItsOffsetFromTheBallsCentre) {
  const Payload square = payload({{0, 0, 0.25}, {1, 0, 0.25}, {1, 1, 0.25}, {0, 1, 0.25}});
  const PackedSlab slab = pack_slab(square, {0.5, 0.5, 0}, 1);
  EXPECT_EQ(slab.offset * slab.nz, 63 * 126);  // a quarter of an edge along a normal of 126/128
  EXPECT_LE(slab.half, 2);
}

TEST(PackSlab, OfAPointIsOneUnitAcrossSomeAxis) {
  const PackedSlab slab = pack_slab(payload({{0.1, 0.2, 0.3}}), {0.1, 0.2, 0.3}, 1);
  EXPECT_EQ(slab.nx * slab.nx + slab.ny * slab.ny + slab.nz * slab.nz, 126 * 126);
  EXPECT_EQ(slab.half, 1);
}

TEST(PackSlab, HoldsEverythingWhereItsNumbersDoNotReach) {
  const PackedSlab all{0, 0, 0, 0, 255};
  EXPECT_EQ(pack_slab(payload({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), {0, 0, 2}, 1), all);
}

}  // namespace
}  // namespace ist
