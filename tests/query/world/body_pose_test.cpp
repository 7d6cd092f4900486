#include "ist/query/world/body_pose.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>

#include "query/query_cases.h"
#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

// The way from one body to another, against rational numbers: right to the last bits of its own
// length, wherever both lie.
TEST(BodyPose, IsComposedWithoutRegardToThePlace) {
  Random random(0);
  for (int turn = 0; turn < samples(300); ++turn) {
    const double place = std::ldexp(1.0, static_cast<int>(random.below(45U)));
    const Eigen::Vector3d there = place * random.direction();
    const auto pose = [&](const Eigen::Vector3d& by) {
      return *body_pose(pose_of(random.rotation(), there + by));
    };
    const BodyPose a = pose(random.point(-1, 1)), b = pose(random.point(-1, 1));
    const BodyPose found = between(a, b);
    double length = 0;
    mpq_class error = 0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      mpq_class exact = 0;
      for (Eigen::Index k = 0; k < 3; ++k) {
        exact += mpq_class(a.rotation(k, i)) *
                 (mpq_class(b.translation[k]) - mpq_class(a.translation[k]));
      }
      length = std::max(length, std::abs(exact.get_d()));
      error = std::max(error, mpq_class(abs(exact - found.translation[i])));
      for (Eigen::Index j = 0; j < 3; ++j) {
        mpq_class turned = 0;
        for (Eigen::Index k = 0; k < 3; ++k) {
          turned += mpq_class(a.rotation(k, i)) * mpq_class(b.rotation(k, j));
        }
        EXPECT_LE(abs(mpq_class(turned - found.rotation(i, j))), 0x1p-52);
      }
    }
    EXPECT_LE(error, 0x1p-52 * length) << place;
  }
}

// With one body at rest in the origin, the way is the other one's pose.
TEST(BodyPose, FromTheOriginIsTheOthersPose) {
  Random random(1);
  const BodyPose here, there = *body_pose(pose_of(random.rotation(), random.point(-9, 9)));
  EXPECT_EQ(between(here, there).rotation, there.rotation);
  EXPECT_EQ(between(here, there).translation, there.translation);
}

}  // namespace
}  // namespace ist::test
