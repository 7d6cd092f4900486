// What counts as a contact besides bounds that touch.

#include <gtest/gtest.h>

#include "ist/tree/sphere_tree.h"
#include "query/contacts/contact_cases.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// A plate a little above another: what of it counts, and with which weight, by reach.
TEST(ContactReach, CountsPairsThatAreNoFartherApart) {
  constexpr double kSize = 0.25;
  BuildOptions build;
  build.voxel_size = kSize;
  const SphereTree lower = build_tree(box({-1, -1, -1}, {1, 1, 0}), build);
  const SphereTree upper = build_tree(box({-1, -1, 0}, {1, 1, 1}), build);
  Query query(lower, upper);
  ASSERT_EQ(query.policy(), SpherePolicy::kSlab);
  const auto sums_at = [&](double gap, double reach) {
    ManifoldOptions options;
    options.margin = 1;
    options.reach = reach;
    ContactManifold points(lower, upper, query.policy(), options);
    return find_contacts(query, points, pose_of(Eigen::Matrix3d::Identity(), {0, 0, gap * kSize}))
        .sums;
  };
  // Leaves at the plates' edges have thick slabs, and meet to a voxel's edge above each other.
  EXPECT_EQ(sums_at(0.9, 0).pairs, 0u);
  const ContactSums few = sums_at(0.9, 0.25), more = sums_at(0.9, 0.5);
  EXPECT_GT(few.pairs, 100u);
  EXPECT_GT(few.weight, 0);
  EXPECT_GT(more.pairs, few.pairs);
  EXPECT_GT(more.weight, 2 * few.weight);
  EXPECT_GT(more.pressure.force.z(), 0.9 * more.weight);
  // Those in their middle, which are flat, meet only by reach.
  EXPECT_GT(sums_at(0.3, 0.5).weight, 3 * sums_at(0.3, 0).weight);
}

}  // namespace
}  // namespace ist::test
