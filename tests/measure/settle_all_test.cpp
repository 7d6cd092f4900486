#include <gtest/gtest.h>

#include <numbers>

#include "ist/measure/settle.h"
#include "measure/body_pair.h"
#include "measure/settle_shapes.h"
#include "support/random.h"

namespace ist::test {
namespace {

using Pose = Eigen::Isometry3d;
using Vector = Eigen::Vector3d;

// A box above two grooves side by side: its lower edge rests in one of them.
struct TwoGrooves {
  TwoGrooves()
      : fixed(build_tree(
            joined(moved(v_groove(3, 10), {0, -4, 0}), moved(v_groove(3, 10), {0, 4, 0.5})))),
        moving(build_tree(
            turned(box({-2, -1, -1}, {2, 1, 1}),
                   Eigen::AngleAxisd(std::numbers::pi / 4, Vector::UnitX()).toRotationMatrix()))),
        query(fixed, moving) {
    options.closing = {0, 0, -1};
    options.load_point = Vector(0, 0, 0);
    options.held = {true, false, false, false, false, true};
    options.largest_way = 4;
    Random random(1);
    for (int i = 0; i < 12; ++i) {
      const double side = i % 3 == 0 ? 4 : -4;
      poses.push_back(place(Vector(0, side, 2.5) +
                            Vector(0, random.uniform(-0.5, 0.5), random.uniform(0, 0.5))));
    }
  }
  SphereTree fixed, moving;
  Query query;
  SettleOptions options;
  std::vector<Pose> poses;
};

TEST(SettleAll, IsSettleFromEachPose) {
  TwoGrooves bodies;
  const std::vector<Settlement> all = settle_all(bodies.query, bodies.poses, bodies.options);
  ASSERT_EQ(all.size(), bodies.poses.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Settlement one = settle(bodies.query, bodies.poses[i], bodies.options);
    EXPECT_EQ(all[i].status, one.status);
    EXPECT_TRUE(all[i].pose().isApprox(one.pose(), 0)) << i;
    EXPECT_EQ(all[i].remaining, one.remaining) << i;
  }
}

TEST(SettleAll, GroupsByHeightAndContacts) {
  TwoGrooves bodies;
  const std::vector<Settlement> all = settle_all(bodies.query, bodies.poses, bodies.options);
  const std::vector<SettleGroup> groups = group_settled(all, bodies.options.closing, 1);
  ASSERT_EQ(groups.size(), 2u);
  // The lower groove closes farther, and two of three starts are above it.
  EXPECT_EQ(groups[0].members.size(), 8u);
  EXPECT_EQ(groups[1].members.size(), 4u);
  EXPECT_NEAR(groups[0].height - groups[1].height, 0.5, 1e-3);
  for (const std::size_t i : groups[1].members) EXPECT_EQ(i % 3, 0u);
}

TEST(SettleAll, AnEndLeavesTheRestStopped) {
  TwoGrooves bodies;
  const std::vector<Settlement> all =
      settle_all(bodies.query, bodies.poses, bodies.options, [](double) { return false; });
  for (const Settlement& one : all) EXPECT_EQ(one.status, Settlement::Status::kStopped);
  EXPECT_TRUE(group_settled(all, bodies.options.closing, 1).empty());
}

}  // namespace
}  // namespace ist::test
