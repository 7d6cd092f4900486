#include "ist/query/world/broad_phase.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "ist/query/traversal/root_test.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/query/world/body_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "query/triangles/triangle_tree.h"
#include "query/world/world_cases.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shapes.h"

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

// If one body rests in the origin, the relative pose is the pose of the other body.
TEST(BodyPose, FromTheOriginIsTheOthersPose) {
  Random random(1);
  const BodyPose here, there = *body_pose(pose_of(random.rotation(), random.point(-9, 9)));
  EXPECT_EQ(between(here, there).rotation, there.rotation);
  EXPECT_EQ(between(here, there).translation, there.translation);
}

// The broad phase loses no pair whose roots' bounds are near, to the last bit; and it does not look
// at all pairs.

// Balls whose root is the circumsphere of a cube round the origin of the frame, the largest bound.
SphereTree ball_of_cubes(double radius) {
  return build_tree(icosphere(1, radius), {.voxel_size = radius / 3, .keep_triangles = false});
}

bool roots_meet(const SphereTree& a, const SphereTree& b, const Eigen::Isometry3d& pose,
                double margin) {
  const auto relative = relative_pose(pose, parts_of(a).origin, parts_of(b).origin);
  return test_roots(a, b, SpherePolicy::kSimple, *relative, margin).overlap;
}

// Two bodies, anywhere, as far apart as their roots can be and still meet.
TEST(BroadPhase, HoldsPairsWhoseRootsTouchToTheLastBit) {
  Random random(0);
  for (int turn = 0; turn < samples(200) && !::testing::Test::HasFailure(); ++turn) {
    const double size = std::ldexp(1.0, static_cast<int>(random.below(20U)) - 10);
    const SphereTree a = ball_of_cubes(size), b = ball_of_cubes(size * random.uniform(0.1, 1));
    const double place =
        turn % 2 == 0 ? 0 : size * std::ldexp(1.0, static_cast<int>(random.below(30U)));
    WorldOptions options = small_world();
    options.query.policy = SpherePolicy::kSimple;
    options.reach = turn % 3 == 0 ? size : 0;
    World world(options);
    const Eigen::Isometry3d first = pose_of(random.rotation(), place * random.direction());
    const Eigen::Matrix3d turned = random.rotation();
    const Eigen::Vector3d away = random.direction();
    world.add(a, first);
    world.add(b, first);
    world.reserve();
    const auto pose_at = [&](double t) {
      world.set_pose(1, pose_of(turned, first.translation() + t * away));
      return *world.pose_of(0, 1);
    };
    const double last = last_touching(
        0, 20 * size, [&](double t) { return roots_meet(a, b, pose_at(t), options.reach); });
    static_cast<void>(pose_at(last));
    EXPECT_EQ(world.ask(kNear).near_pairs, 1u) << turn;
    static_cast<void>(pose_at(1.01 * last));
    EXPECT_EQ(world.ask(kNear).near_pairs, 0u) << turn;
  }
}

// Two bodies, anywhere, as far apart as any two bounds of theirs can be and still overlap in a
// search in float: their bounding radii, and the pad of inner nodes.
TEST(BroadPhase, HoldsBallsThatTouchWithTheirPads) {
  Random random(2);
  for (int turn = 0; turn < samples(200) && !::testing::Test::HasFailure(); ++turn) {
    const double size = std::ldexp(1.0, static_cast<int>(random.below(20U)) - 10);
    const SphereTree a = ball_of_cubes(size), b = ball_of_cubes(size * random.uniform(0.1, 1));
    const double radii = a.bounding_radius() + b.bounding_radius();
    const double reach = turn % 3 == 0 ? size : 0;
    const Eigen::Isometry3d first = pose_of(random.rotation(), size * random.direction());
    const Eigen::Matrix3d turned = random.rotation();
    const Eigen::Vector3d away = random.direction();
    BroadPhase broad;
    broad.reserve(2);
    broad.add();
    broad.add();
    broad.set(0, ball_of(a, *body_pose(first), reach, 0));
    const auto near_at = [&](double t) {
      const Eigen::Isometry3d second = pose_of(turned, first.translation() + t * away);
      broad.set(1, ball_of(b, *body_pose(second), reach, 0));
      const BodyPose pose = between(*body_pose(first), *body_pose(second));
      const auto relative =
          relative_pose(to_isometry(pose), parts_of(a).origin, parts_of(b).origin);
      const Eigen::Vector3d& way = relative->translation;
      return way.norm() <= radii + inner_ball_pad(radii, way.cwiseAbs().maxCoeff(), reach);
    };
    ASSERT_TRUE(near_at(last_touching(0, 20 * size, near_at)));
    int found = 0;
    broad.near([&](BodyPair) { ++found; });
    EXPECT_EQ(found, 1) << turn;
  }
}

// Against all pairs of many bodies, as they move.
TEST(BroadPhase, FindsWhatAllPairsTell) {
  Random random(1);
  const SphereTree tree = ball_of_cubes(1);
  for (const std::size_t count : {0u, 1u, 2u, 3u, 150u}) {
    BroadPhase broad;
    broad.reserve(count);
    for (std::size_t i = 0; i < count; ++i) broad.add();
    std::vector<BodyBall> balls(count);
    std::vector<bool> there(count, false);
    for (int tick = 0; tick < samples(30); ++tick) {
      for (BodyIndex body = 0; body < count; ++body) {
        if (tick > 0 && random.below(3U) > 0) continue;
        there[body] = random.below(10U) > 0;
        Eigen::Vector3d at = random.point(-8, 8);
        at[tick % 3] *= 4;
        balls[body] = ball_of(tree, {random.rotation(), at}, 0.1, 1);
        if (there[body]) {
          broad.set(body, balls[body]);
        } else {
          broad.take_out(body);
        }
      }
      std::set<BodyPair> expected, found;
      double least = HUGE_VAL;
      for (BodyIndex a = 0; a < count; ++a) {
        for (BodyIndex b = a + 1; b < count; ++b) {
          if (!there[a] || !there[b]) continue;
          const double apart = (balls[b].centre - balls[a].centre).norm();
          const double radii = balls[a].radius + balls[b].radius;
          if (apart <= radii + balls[a].margin + balls[b].margin) expected.insert({a, b});
          least = std::min(least, apart + radii);
        }
      }
      broad.near([&](BodyPair pair) { EXPECT_TRUE(found.insert(pair).second); });
      EXPECT_EQ(found, expected);
      std::size_t looked = 0;
      double upper = HUGE_VAL;
      broad.nearest([&](BodyPair, const DistanceInterval& distance) {
        ++looked;
        upper = std::min(upper, distance.upper);
        return true;
      });
      if (least < HUGE_VAL) {
        EXPECT_NEAR(upper, least, 1e-9);
      }
      if (count > 100) {
        EXPECT_LT(looked, count * count / 8);
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
