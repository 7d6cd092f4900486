#include "ist/voxel/packed_normal.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/effort.h"
#include "support/random.h"
#include "voxel/angles.h"

namespace ist {
namespace {

using Eigen::Vector3d;
using test::angle_in_degrees;

Vector3d stored(const Vector3d& normal) { return PackedNormal(normal, 1).direction(); }

TEST(PackedNormal, GivesADirectionBackWithinItsError) {
  test::Random random(1);
  double worst = 0;
  for (int i = 0; i < test::samples(300'000); ++i) {
    const Vector3d normal = random.direction();
    const Vector3d back = stored(normal);
    worst = std::max(worst, angle_in_degrees(normal, back));
    ASSERT_NEAR(back.norm(), 1, 1e-15);
  }
  EXPECT_LE(worst, 0.06);
}

TEST(PackedNormal, DirectionsNearTheFoldsComeBackToo) {
  test::Random random(2);
  for (int i = 0; i < test::samples(30'000); ++i) {
    Vector3d normal = random.direction();
    normal[static_cast<Eigen::Index>(random.below(3))] *= i % 4 == 0 ? 0 : 1e-4;
    normal.normalize();
    ASSERT_LE(angle_in_degrees(normal, stored(normal)), 0.06) << normal.transpose();
  }
}

TEST(PackedNormal, AxesComeBackExactly) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Vector3d normal = sign * Vector3d::Unit(axis);
      EXPECT_EQ(stored(normal), normal);
    }
  }
}

TEST(PackedNormal, MirroringANormalMirrorsWhatIsStored) {
  test::Random random(3);
  for (int i = 0; i < test::samples(100'000); ++i) {
    const Vector3d normal = random.direction();
    for (int axis = 0; axis < 3; ++axis) {
      const auto mirrored = [axis](Vector3d v) {
        v[axis] = -v[axis];
        return v;
      };
      // The stored steps are the same; unfolding the lower half rounds once more.
      const Vector3d difference = stored(mirrored(normal)) - mirrored(stored(normal));
      ASSERT_LE(difference.cwiseAbs().maxCoeff(), axis == 2 ? 1e-15 : 0.0) << normal.transpose();
    }
  }
}

TEST(PackedNormal, CoherenceIsTheLengthOfTheSumByTheWeight) {
  test::Random random(4);
  for (int i = 0; i < test::samples(10'000); ++i) {
    const double weight = random.uniform(0.1, 100), coherence = random.uniform(0, 1);
    const Vector3d sum = coherence * weight * random.direction();
    const PackedNormal packed(sum, weight);
    EXPECT_NEAR(packed.coherence(), coherence, 0.5 / 255 + 1e-12);
    EXPECT_TRUE(packed.coherence() == 0 || angle_in_degrees(sum, packed.direction()) <= 0.06);
  }
  EXPECT_EQ(PackedNormal({0, 0, 1 + 1e-12}, 1).coherence(), 1.0) << "rounding stays below 1";
}

TEST(PackedNormal, WhatHasNoDirectionIsZeroAndNeverNaN) {
  EXPECT_EQ(PackedNormal().word(), 0u);
  for (const auto& [sum, weight] :
       {std::pair(Vector3d(0, 0, 0), 0.0), std::pair(Vector3d(0, 0, 0), 5.0),
        std::pair(Vector3d(1e-9, 0, 0), 5.0), std::pair(Vector3d(0, 0, 5e-324), 5e-324)}) {
    const PackedNormal packed(sum, weight);
    EXPECT_TRUE(packed.direction().allFinite());
    if (packed.coherence() == 0) {
      EXPECT_EQ(packed.word(), 0u);
      EXPECT_EQ(packed.direction(), Vector3d(0, 0, 0));
    }
  }
}

TEST(PackedNormal, AnyWordIsANormal) {
  test::Random random(5);
  for (int i = 0; i < test::samples(200'000); ++i) {
    const auto word = static_cast<std::uint32_t>(random.bits());
    const PackedNormal normal = PackedNormal::from_word(word);
    ASSERT_EQ(normal.word(), word);
    ASSERT_NEAR(normal.direction().norm(), (word & 255) == 0 ? 0 : 1, 1e-15);
  }
  for (const std::uint32_t word : {0u, 255u, 0xFFFFFFFFu, 0xFFF000FFu, 0x000FFFFFu}) {
    EXPECT_TRUE(PackedNormal::from_word(word).direction().allFinite());
  }
}

}  // namespace
}  // namespace ist
