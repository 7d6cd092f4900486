#include "ist/query/traversal/search_pose.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "query/query_cases.h"
#include "support/effort.h"

namespace ist::test {
namespace {

RelativePose random_relative(Random& random) {
  const double away = std::ldexp(1.0, static_cast<int>(random.below(40)) - 20);
  return {random.rotation(), away * random.direction()};
}

// The fixed frame's origin in the moving frame, each number of it rounded once.
TEST(SearchPose, IsThePoseTurnedRoundAndRoundedOnce) {
  Random random(21);
  for (int i = 0; i < samples(2000); ++i) {
    const RelativePose pose = random_relative(random);
    const SearchPose narrowed = to_float(pose, {0.5, 0.1, 0.08}, {0.5, 0.1, 0.08});
    double error = 0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      mpq_class exact = 0;
      for (Eigen::Index k = 0; k < 3; ++k) {
        exact -= mpq_class(pose.rotation(k, axis)) * mpq_class(pose.translation[k]);
        EXPECT_EQ(narrowed.rotation[3 * axis + k], static_cast<float>(pose.rotation(k, axis)));
      }
      const mpq_class off = mpq_class(double{narrowed.translation[axis]}) - exact;
      error = std::max(error, std::abs(off.get_d()));
    }
    EXPECT_LE(error, 0x1p-24 * (1 + 1e-6) * pose.translation.norm());
  }
}

// What the kernels err by rises with both bodies and with the way between them; see
// search_pose.cpp.
TEST(SearchPose, HasPadsThatRiseWithBodiesAndPlace) {
  Random random(22);
  for (int i = 0; i < samples(2000); ++i) {
    const RelativePose pose = random_relative(random);
    const double radius = random.uniform(1e-3, 1e3), margin = random.uniform(0, 1);
    const double u = 0x1p-24 * (radius + pose.translation.norm());
    const TreeLengths half{0.5 * radius, 1e3, 0.8};  // for voxels as large no slab rises
    const SearchPose narrowed = to_float(pose, half, half, margin);
    const auto expect_pad = [](float pad, double least, double most) {
      EXPECT_GE(pad, least);
      EXPECT_LE(pad, 1.001 * most);
    };
    expect_pad(narrowed.leaf.ball, 12 * u + margin, 13 * u + margin);
    expect_pad(narrowed.leaf.slab_fixed, 16.9 * u + margin, 17 * u + margin);
    EXPECT_EQ(narrowed.leaf.slab_moving, narrowed.leaf.slab_fixed);
    // Twice what a leaf is kept by, and what the test of an inner node errs by.
    expect_pad(narrowed.inner.ball, 37 * u + margin, 38 * u + margin);
    expect_pad(narrowed.inner.slab_fixed, (2 * 17 + 18.6) * u + margin, 53.1 * u + margin);
    EXPECT_EQ(narrowed.inner.slab_moving, narrowed.inner.slab_fixed);
  }
}

// The slabs of inner nodes are nested for a reach of 5/4 voxel and count as wider for a larger one.
TEST(SearchPose, HasWiderInnerSlabsForLargerPartners) {
  const RelativePose still{Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  const TreeLengths fine{1e-3, 0.1, 0.08}, coarse{1e-3, 0.8, 0.64};
  const auto inner = [&](const TreeLengths& a, const TreeLengths& b, double margin) {
    return to_float(still, a, b, margin).inner;
  };
  EXPECT_NEAR(inner(fine, fine, 0.04).slab_fixed, 0.04, 1e-5);
  EXPECT_NEAR(inner(fine, fine, 0.3).slab_fixed, 0.3 + (0.38 - 0.125) / 3, 1e-5);
  EXPECT_NEAR(inner(fine, coarse, 0).slab_fixed, (0.64 - 0.125) / 3, 1e-5);
  EXPECT_NEAR(inner(fine, coarse, 0).slab_moving, 0, 1e-5);
  EXPECT_NEAR(inner(coarse, fine, 0).slab_moving, (0.64 - 0.125) / 3, 1e-5);
  EXPECT_NEAR(inner(fine, coarse, 0).ball, 0, 1e-5);
  EXPECT_NEAR(to_float(still, fine, coarse, 0).leaf.slab_fixed, 0, 1e-5);
}

// A larger margin, made from a smaller one, is no smaller than if it were made at once.
TEST(SearchPose, InflatedHasAllPadsOfALargerMargin) {
  Random random(23);
  for (int i = 0; i < samples(2000); ++i) {
    const RelativePose pose = random_relative(random);
    const TreeLengths a{random.uniform(1, 10), random.uniform(0.1, 1), random.uniform(0.01, 1)},
        b{random.uniform(1, 10), random.uniform(0.1, 1), random.uniform(0.01, 1)};
    const double margin = random.uniform(0, 0.1), by = random.uniform(0, 3);
    const SearchPose whole = to_float(pose, a, b, margin + by),
                     made = inflated(to_float(pose, a, b, margin), by);
    for (const auto& [wanted, found] :
         {std::pair(whole.leaf, made.leaf), std::pair(whole.inner, made.inner)}) {
      EXPECT_GE(found.ball, wanted.ball * (1 - 0x1p-23F));
      EXPECT_LE(found.ball, wanted.ball * (1 + 0x1p-21F));
      EXPECT_GE(found.slab_fixed, wanted.slab_fixed * (1 - 0x1p-23F));
      EXPECT_GE(found.slab_moving, wanted.slab_moving * (1 - 0x1p-23F));
    }
  }
}

}  // namespace
}  // namespace ist::test
