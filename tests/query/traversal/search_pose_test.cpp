#include "ist/query/traversal/search_pose.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "query/query_cases.h"

namespace ist::test {
namespace {

RelativePose random_relative(Random& random) {
  const double away = std::ldexp(1.0, static_cast<int>(random.below(40)) - 20);
  return {random.rotation(), away * random.direction()};
}

// The fixed frame's origin in the moving frame, each number of it rounded once.
TEST(SearchPose, IsThePoseTurnedRoundAndRoundedOnce) {
  Random random(21);
  for (int i = 0; i < 2000; ++i) {
    const RelativePose pose = random_relative(random);
    const SearchPose narrowed = to_float(pose, 1);
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

// What the kernels err by grows with both bodies and with the way between them; see
// search_pose.cpp.
TEST(SearchPose, HasPadsThatGrowWithBodiesAndPlace) {
  Random random(22);
  for (int i = 0; i < 2000; ++i) {
    const RelativePose pose = random_relative(random);
    const double reaches = random.uniform(1e-3, 1e3), margin = random.uniform(0, 1);
    const double lengths = reaches + pose.translation.norm();
    const SearchPose narrowed = to_float(pose, reaches, margin);
    EXPECT_GE(narrowed.ball_pad, 12 * 0x1p-24 * lengths + margin);
    EXPECT_LE(narrowed.ball_pad, 1.001 * (13 * 0x1p-24 * lengths + margin));
    EXPECT_GE(narrowed.slab_pad, 16.9 * 0x1p-24 * lengths + margin);
    EXPECT_LE(narrowed.slab_pad, 1.001 * (17 * 0x1p-24 * lengths + margin));
  }
}

}  // namespace
}  // namespace ist::test
