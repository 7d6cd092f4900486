#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ist/measure/first_contact.h"
#include "ist/measure/settle.h"
#include "ist/models/models.h"
#include "measure/body_pair.h"
#include "measure/settle_shapes.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

using Pose = Eigen::Isometry3d;
using Vector = Eigen::Vector3d;

// Two jaws, and starts around their first contact: opened by 1 mm, moved by up to 1 mm along each
// axis, and turned by up to 1.5 degrees.
struct Jaws {
  Jaws(const TriangleMesh& upper, const TriangleMesh& lower, double open, double reach)
      : fixed(build_tree(upper)), moving(build_tree(lower)), query(fixed, moving), settler(query) {
    const FirstContact contact =
        first_contact(query, place({0, 0, open}), place({0, 0, open + reach}), 1e-3);
    height = open + contact.lower * reach;
    nominal = place({0, 0, height - 1});
    // One load for all starts.
    load = settler.settle(nominal, {}).load_point;
  }

  Pose start(Random& random) {
    const Vector turn = random.direction();
    Pose pose = place(random.point(-1, 1)) * nominal *
                turn_about(moving.origin(), turn, random.uniform(0, 1.5) * std::numbers::pi / 180);
    while (query.intersects(pose).answer != Answer::kNo) pose.translation()[2] -= 0.25;
    return pose;
  }

  SphereTree fixed, moving;
  Query query;
  Settler settler;
  double height = 0;
  Pose nominal;
  Vector load;
};

struct Count {
  int rests = 0, leaves = 0, failed = 0;
};

// Settles from random starts, and tries free motions from each rest.
Count settle_from(Jaws& jaws, int starts, double way, int tries) {
  Count count;
  Random random(1);
  for (int i = 0; i < starts; ++i) {
    SettleOptions options{.load_point = jaws.load, .largest_way = way};
    options.largest_turn = way * std::numbers::pi / 120;
    const Settlement settled = jaws.settler.settle(jaws.start(random), options);
    EXPECT_TRUE(settled.free) << i;
    EXPECT_EQ(jaws.query.intersects(settled.pose()).answer, Answer::kNo) << i;
    if (settled.status == Settlement::Status::kLeftTheBox) {
      ++count.leaves;
      continue;
    }
    const bool rests = settled.status == Settlement::Status::kRests ||
                       settled.status == Settlement::Status::kRestsLevel;
    ++(rests ? count.rests : count.failed);
    EXPECT_TRUE(rests) << i << ' ' << to_string(settled.status) << ' ' << settled.residual << ' '
                       << settled.remaining;
    if (!rests) continue;
    EXPECT_LE(settled.residual, 1e-3);
    EXPECT_LE(settled.remaining, 1e-3);
    EXPECT_LE(settled.distance.upper, 0.01);
    EXPECT_GE(settled.contacts.size(), 3u);
    double farthest = -HUGE_VAL;
    for (int k = 0; k < tries; ++k) {
      const double size = settled.reach * std::pow(random.uniform(0, 1), 2) / std::sqrt(2.0);
      Vector way_of_load = size * random.direction();
      way_of_load[2] = std::abs(way_of_load[2]) * random.uniform(0, 1);
      const Pose turned = turn_about(settled.pose() * settled.load_point, random.direction(),
                                     size / settled.radius * random.uniform(0, 1)) *
                          settled.pose();
      if (jaws.query.intersects(place(way_of_load) * turned).answer != Answer::kNo) continue;
      farthest = std::max(farthest, way_of_load[2]);
    }
    EXPECT_LE(farthest, settled.remaining + settled.second_order) << i;
  }
  return count;
}

TEST(SettleBodies, HumanJaws_RestFromEveryStart) {
  IST_SLOW();
  const auto folder = data_dir();
  if (!std::filesystem::exists(folder / "human_maxilla.stl")) IST_SKIP("no real meshes");
  Jaws jaws(read_mesh(folder / "human_maxilla.stl"), read_mesh(folder / "human_mandible.stl"), -3,
            7);
  const Count count = settle_from(jaws, samples(100), 4, samples(10'000) / 100);
  EXPECT_EQ(count.rests, samples(100));
}

TEST(SettleBodies, BuiltInJaws_RestFromEveryStart) {
  Jaws jaws(make_jaw(Jaw::kUpper, 7), make_jaw(Jaw::kLower, 7), -4, 8);
  const Count count = settle_from(jaws, samples(20), 4, samples(500));
  EXPECT_EQ(count.rests, samples(20));
}

TEST(SettleBodies, SmoothJaws_RestOrLeaveTheBox) {
  const auto folder = data_dir();
  if (!std::filesystem::exists(folder / "spl_mandible.stl")) IST_SKIP("no real meshes");
  Jaws jaws(read_mesh(folder / "spl_cranium_face.stl"), read_mesh(folder / "spl_mandible.stl"), -6,
            10);
  const Count count = settle_from(jaws, samples(50), 4, samples(100));
  EXPECT_EQ(count.failed, 0);
}

}  // namespace
}  // namespace ist::test
