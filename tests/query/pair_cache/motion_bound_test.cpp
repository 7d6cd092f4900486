#include "ist/query/pair_cache/motion_bound.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "ist/query/pair_cache/pose_track.h"
#include "ist/tree/tree_parts.h"
#include "query/pair_cache/cache_case.h"
#include "query/query_cases.h"
#include "simd/lanes.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// How far a motion brings two bodies nearer each other is bounded, and not by more than the box in
// which they can be near moves.

struct LeafBound {
  Eigen::Vector3d centre;
  double radius;
  Eigen::Vector3d normal;  // of its slab; 0 without
  double offset, half;
};

// The bounds of all leaves in their tree's frame.
std::vector<LeafBound> leaf_bounds(SearchSide side, const SphereTree& tree) {
  side.descends = true;
  side.emits_slots = false;
  std::vector<LeafBound> all;
  const auto parents = static_cast<std::uint32_t>(voxels_of(tree).octree.nodes(1).size() - 1);
  FixedLanes lanes;
  for (std::uint32_t parent = 0; parent < parents; ++parent) {
    const std::uint32_t count = decode(side, parent, lanes, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto at = [&](Lane lane) { return static_cast<double>(lanes.lane[lane][i]); };
      LeafBound leaf{{at(kX), at(kY), at(kZ)}, at(kRadius), {0, 0, 0}, 0, 0};
      if (side.slabs != nullptr) {
        leaf.normal = Eigen::Vector3d(at(kNormalX), at(kNormalY), at(kNormalZ)) / kSlabScale;
        leaf.offset = at(kOffset) / kSlabScale;
        leaf.half = at(kHalf) / kSlabScale;
      }
      all.push_back(leaf);
    }
  }
  return all;
}

// How far two leaves are apart, by their balls or by a slab, whichever says more.
double separation(const LeafBound& fixed, const LeafBound& moving, const RelativePose& pose) {
  const Eigen::Vector3d apart = moved(pose, moving.centre) - fixed.centre;
  double most = apart.norm() - fixed.radius - moving.radius;
  if (fixed.normal.isZero(0)) return most;
  const Eigen::Vector3d normal = turned(pose, moving.normal);
  most =
      std::max(most, std::abs(fixed.normal.dot(apart) - fixed.offset) - fixed.half - moving.radius);
  return std::max(most, std::abs(normal.dot(apart) + moving.offset) - moving.half - fixed.radius);
}

// A motion by about `by`, turned about a point near the bodies.
RelativePose moved_on(const RelativePose& pose, double by, Random& random) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(by * random.uniform(0, 1), random.direction()).toRotationMatrix();
  const Eigen::Vector3d about = random.point(-1.5, 1.5);
  return {turn * pose.rotation, turn * (pose.translation - about) + about +
                                    by * random.uniform(0, 1) * random.direction()};
}

class MotionBoundOf : public ::testing::TestWithParam<SpherePolicy> {};

INSTANTIATE_TEST_SUITE_P(Policies, MotionBoundOf, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(MotionBoundOf, HoldsForAllLeavesThatAreNear) {
  Random random(1);
  std::uint64_t near = 0;
  double tightest = 0;
  for (const Scene& scene : solids()) {
    const CacheCase scene_case(scene.fixed, scene.moving, GetParam());
    const MotionBound bound(scene.fixed, scene.moving, GetParam());
    const SearchStep& last = scene_case.plan.steps().back();
    const auto fixed = leaf_bounds(last.fixed, scene.fixed);
    const auto moving = leaf_bounds(last.moving, scene.moving);
    for (int round = 0; round < 60; ++round) {
      const RelativePose to{random.rotation(), random.uniform(0, 2.2) * random.direction()};
      const RelativePose from =
          moved_on(to, scene_case.voxel * std::pow(10, random.uniform(-4, 1)), random);
      const double reach = scene_case.voxel * random.uniform(0, 3);
      const double motion = bound.between(from, to, reach);
      for (int i = 0; i < samples(2000); ++i) {
        const LeafBound& a = fixed[random.below(fixed.size())];
        // The nearest of a few.
        const LeafBound* b = nullptr;
        double least = HUGE_VAL;
        for (int k = 0; k < 12; ++k) {
          const LeafBound& other = moving[random.below(moving.size())];
          const double apart = separation(a, other, to);
          if (apart < least) {
            least = apart;
            b = &other;
          }
        }
        if (least > reach) continue;
        ++near;
        const double change = std::abs(separation(a, *b, from) - least);
        ASSERT_LE(change, motion) << scene.name << ", round " << round;
        tightest = std::max(tightest, change / motion);
      }
    }
  }
  EXPECT_GT(near, least(9'000u, 1'400u));
  EXPECT_GT(tightest, least(0.9, 0.8));
}

// The corners of triangles are points of surfaces, also far from their trees' origins.
TEST(MotionBounds, HoldForPointsThatAreNear) {
  Random random(2);
  int near = 0;
  for (const double away : {0.0, 700.0}) {
    const TriangleMesh ball = icosphere(2, 1),
                       block = joined(box({-0.9, -0.7, -0.8}, {0.9, 0.7, 0.8}),
                                      box(Eigen::Vector3d::Constant(away + 1),
                                          Eigen::Vector3d::Constant(away + 1.2)));
    const SphereTree fixed = tree_of(ball, 20), moving = tree_of(block, away > 0 ? 8000 : 16);
    const MotionBound bound(fixed, moving, SpherePolicy::kSlab);
    const CacheCase bodies(fixed, moving, SpherePolicy::kSlab);
    const auto apart = [&](const RelativePose& pose, const Eigen::Vector3d& p,
                           const Eigen::Vector3d& q) {
      return (moved(pose, q - moving.origin()) - (p - fixed.origin())).norm();
    };
    for (int round = 0; round < samples(400); ++round) {
      const RelativePose to = bodies.relative(
          near_touch(ball, block, random.rotation(), 0.3 * random.uniform(0, 1), random));
      const RelativePose from = moved_on(to, std::pow(10, random.uniform(-4, 0)), random);
      const double reach = random.uniform(0, 0.4);
      const double motion = bound.between(from, to, reach);
      for (const Eigen::Vector3d& p : ball.vertices) {
        for (const Eigen::Vector3d& q : block.vertices) {
          const double after = apart(to, p, q);
          if (after > reach) continue;
          ++near;
          ASSERT_LE(std::abs(apart(from, p, q) - after), motion);
        }
      }
    }
  }
  EXPECT_GT(near, least(500, 50));
}

// A translation is as far as it is, and its sum with the rounding no more.
TEST(MotionBounds, OfATranslationIsItsLength) {
  const SphereTree tree = tree_of(icosphere(2, 1), 20);
  const MotionBound bound(tree, tree, SpherePolicy::kTable);
  Random random(3);
  for (int i = 0; i < samples(1000); ++i) {
    const RelativePose to{random.rotation(), random.uniform(0, 1.5) * random.direction()};
    const double length = std::pow(10, random.uniform(-12, 0));
    const RelativePose from{to.rotation, to.translation + length * random.direction()};
    const double exact = (from.translation - to.translation).norm();
    const double motion = bound.between(from, to, 0.1);
    EXPECT_GE(motion, exact);
    EXPECT_LE(motion, exact * (1 + 1e-9) + 1e-12);
    EXPECT_LE(bound.between(to, to, 0.1), 1e-12);
  }
}

// The parents' cubes of all leaves make a box. Widened by the reach, it has a corner that moves at
// least as far as the bound says.
TEST(MotionBounds, IsNoMoreThanTheMotionOfTheBox) {
  Random random(4);
  for (const Scene& scene : solids()) {
    const MotionBound bound(scene.fixed, scene.moving, SpherePolicy::kSlab);
    const auto box_of = [](const SphereTree& tree) {
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& centre : tree.leaf_centres()) box.extend(centre - tree.origin());
      const Eigen::Vector3d margin = Eigen::Vector3d::Constant(1.51 * tree.voxel_size());
      return Eigen::AlignedBox3d(box.min() - margin, box.max() + margin);
    };
    const Eigen::AlignedBox3d fixed = box_of(scene.fixed), moving = box_of(scene.moving);
    const double leaves = scene.fixed.largest_leaf_radius(SpherePolicy::kSlab) +
                          scene.moving.largest_leaf_radius(SpherePolicy::kSlab);
    for (int round = 0; round < samples(1000); ++round) {
      const RelativePose to{random.rotation(), random.uniform(0, 3) * random.direction()};
      const RelativePose from = moved_on(to, std::pow(10, random.uniform(-5, 0)), random);
      const double reach = random.uniform(0, 0.5);
      Eigen::AlignedBox3d of_moving;
      for (int k = 0; k < 8; ++k) {
        of_moving.extend(moved(to, moving.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k))));
      }
      const Eigen::Vector3d around = Eigen::Vector3d::Constant(1.001 * (reach + leaves));
      const Eigen::AlignedBox3d box(fixed.min().cwiseMax(of_moving.min()) - around,
                                    fixed.max().cwiseMin(of_moving.max()) + around);
      double most = 0;
      if (!box.isEmpty()) {
        for (int k = 0; k < 8; ++k) {
          const Eigen::Vector3d y = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k));
          const Eigen::Vector3d before =
              from.rotation * (to.rotation.transpose() * (y - to.translation)) + from.translation;
          most = std::max(most, (before - y).norm());
        }
      }
      ASSERT_LE(bound.between(from, to, reach), most * (1 + 1e-9) + 1e-11) << scene.name;
    }
  }
}

// A turn about the contact moves the contact less than the far ends of the body.
TEST(MotionBounds, CountsOnlyWhatIsNear) {
  const SphereTree fixed = tree_of(box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), 10);
  const SphereTree moving = tree_of(box({0, -0.1, -0.1}, {20, 0.1, 0.1}), 400);
  const MotionBound bound(fixed, moving, SpherePolicy::kSlab);
  const CacheCase bodies(fixed, moving, SpherePolicy::kSlab);
  const auto at = [&](double angle) {
    Eigen::Isometry3d pose = shift({0.5, 0, 0});
    pose.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    return bodies.relative(pose);
  };
  EXPECT_GT(bound.between(at(0), at(0.01), 0.1), 0.001);
  EXPECT_LT(bound.between(at(0), at(0.01), 0.1), 0.02);
}

TEST(MotionBounds, OfBodiesThatAreFarApartIsNone) {
  const SphereTree tree = tree_of(icosphere(2, 1), 20);
  const MotionBound bound(tree, tree, SpherePolicy::kSlab);
  const RelativePose near{Eigen::Matrix3d::Identity(), {1.9, 0, 0}},
      far{Eigen::Matrix3d::Identity(), {0, 9, 0}};
  EXPECT_EQ(bound.between(near, far, 1), 0);
  EXPECT_NEAR(bound.between(far, near, 1), (far.translation - near.translation).norm(), 1e-9);
  // They are within reach of each other if that is long enough.
  EXPECT_GT(bound.between(near, far, 10), 7);
}

// If two lengths round to the same number, their difference is not lost.
TEST(MotionBounds, OfFarPlacesAreTrueOrNoNumber) {
  const SphereTree tree = tree_of(icosphere(2, 1), 20);
  const MotionBound bound(tree, tree, SpherePolicy::kSlab);
  for (const double far : {1e3, 1e6, 1e12, 1e100}) {
    const RelativePose from{Eigen::Matrix3d::Identity(), {far, 0, 0}},
        to{Eigen::Matrix3d::Identity(), {far * (1 + 1e-9), 0, 0}};
    const double wanted = to.translation[0] - from.translation[0];
    const double motion = bound.between(from, to, 2 * far);
    EXPECT_GE(motion, wanted) << far;
    EXPECT_LE(motion, wanted * (1 + 1e-3)) << far;
  }
  // A bound that is NaN holds nothing, because each comparison by <= is false.
  const RelativePose farthest{Eigen::Matrix3d::Identity(), {1e300, 1e300, 0}},
      here{Eigen::Matrix3d::Identity(), {0, 0, 0}};
  EXPECT_FALSE(bound.between(farthest, here, 1) <= 1);
}

constexpr std::size_t kTicks = PoseTrack::kTicks;

RelativePose pose_at(double angle, const Eigen::Vector3d& translation,
                     const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) {
  return {Eigen::AngleAxisd(angle, axis).toRotationMatrix(), translation};
}

class PoseTracks : public ::testing::Test {
 protected:
  const SphereTree tree_ = tree_of(icosphere(2, 1), 12);
  const MotionBound bound_{tree_, tree_, SpherePolicy::kSlab};
  void add(const RelativePose& pose) { track_.add(pose, bound_, 0.1); }

  PoseTrack track_;
};

TEST_F(PoseTracks, KnowNothingOfOnePose) {
  EXPECT_EQ(track_.speed(), HUGE_VAL);
  EXPECT_EQ(track_.drift(bound_, 0.1), HUGE_VAL);
  add(pose_at(0.3, {1, 0.5, 0}));
  EXPECT_EQ(track_.speed(), HUGE_VAL);
  EXPECT_EQ(track_.drift(bound_, 0.1), HUGE_VAL);
  EXPECT_TRUE(track_.ahead(5).rotation.isApprox(pose_at(0.3, {0, 0, 0}).rotation, 1e-12));
  EXPECT_EQ(track_.ahead(5).translation, Eigen::Vector3d(1, 0.5, 0));
}

TEST_F(PoseTracks, GoStraightOn) {
  const Eigen::Vector3d step(0.001, -0.002, 0.0005);
  for (std::size_t i = 0; i < 40; ++i) {
    const Eigen::Vector3d at = static_cast<double>(i) * step;
    add(pose_at(0, at));
    if (i == 0) continue;
    EXPECT_NEAR(track_.speed(), step.norm(), 1e-12);
    EXPECT_NEAR(track_.drift(bound_, 0.1), step.norm(), 1e-12);
    for (const double ticks : {0.0, 0.5, 4.0, 20.0}) {
      const RelativePose ahead = track_.ahead(ticks);
      EXPECT_LT((ahead.translation - (at + ticks * step)).norm(), 1e-12);
      EXPECT_TRUE(ahead.rotation.isIdentity(1e-12));
    }
  }
}

TEST_F(PoseTracks, TurnOn) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -2) / 3;
  constexpr double kTurn = 0.01;
  for (std::size_t i = 0; i < 700; ++i) {  // more than once round
    add(pose_at(kTurn * static_cast<double>(i), {0, 0, 0}, axis));
    if (i == 0) continue;
    const RelativePose ahead = track_.ahead(10);
    const RelativePose wanted = pose_at(kTurn * (static_cast<double>(i) + 10), {0, 0, 0}, axis);
    EXPECT_LT((ahead.rotation - wanted.rotation).norm(), 1e-9) << i;
    EXPECT_TRUE((ahead.rotation.transpose() * ahead.rotation).isIdentity(1e-12));
  }
}

// The last kTicks alone count, however often the memory went round.
TEST_F(PoseTracks, ForgetWhatIsLongAgo) {
  for (int i = 0; i < 3; ++i) add(pose_at(0, {0.5 * i, 0, 0}));
  EXPECT_NEAR(track_.drift(bound_, 0.1), 0.5, 1e-12);
  for (std::size_t i = 0; i <= kTicks; ++i) add(pose_at(0, {2, 0.01 * static_cast<double>(i), 0}));
  EXPECT_NEAR(track_.drift(bound_, 0.1), 0.01, 1e-12);
  EXPECT_NEAR(track_.speed(), 0.01, 1e-12);
  for (int i = 0; i < 100; ++i) {  // each tick is the fastest for as long
    add(pose_at(0, {2, 0.01 * i, 0}));
    if (i < 4) continue;
    EXPECT_NEAR(track_.speed(), 0.01, 1e-12);
    if (i % 30 != 29) continue;
    for (std::size_t tick = 0; tick < 2 * kTicks; ++tick) {
      add(pose_at(0, {tick == 0 ? 0.0 : 2.0, 0.01 * i, 0}));
      EXPECT_EQ(track_.speed() > 1, tick <= kTicks) << tick;
    }
  }
  track_ = PoseTrack();
  EXPECT_EQ(track_.speed(), HUGE_VAL);
  add(pose_at(0, {0, 0, 1}));
  add(pose_at(0, {0, 0, 1.25}));
  EXPECT_NEAR(track_.drift(bound_, 0.1), 0.25, 1e-12);
  EXPECT_NEAR(track_.ahead(1).translation[2], 1.5, 1e-12);
}

// The body goes to and fro: it is fast, and stays in its place.
TEST_F(PoseTracks, TellTremblingFromMoving) {
  for (int i = 0; i < 21; ++i) add(pose_at(0, {i % 2 == 0 ? 0.02 : -0.02, 0, 0}));
  EXPECT_NEAR(track_.speed(), 0.04, 1e-12);
  EXPECT_NEAR(track_.drift(bound_, 0.1), 0, 1e-12);
  EXPECT_NEAR(track_.ahead(20).translation[0], 0.02, 1e-12);
  EXPECT_FALSE(track_.pace(bound_, 0.1).is_directed());
}

// One step of a body at rest shows in the speed for four ticks. Its direction is unknown.
TEST_F(PoseTracks, TellAStepFromMoving) {
  for (int i = 0; i < 40; ++i) add(pose_at(0, {0, 0, 0}));
  EXPECT_NEAR(track_.speed(), 0, 1e-12);
  for (std::size_t i = 0; i < kTicks; ++i) {
    add(pose_at(0, {0.1, 0, 0}));
    const Pace pace = track_.pace(bound_, 0.1);
    EXPECT_NEAR(pace.speed, 0.1, 1e-12);
    EXPECT_NEAR(pace.drift, 0.1 / kTicks, 1e-12);
    EXPECT_NEAR(pace.course, 0.1 / PoseTrack::kManyTicks, 1e-12);
    EXPECT_FALSE(pace.is_directed());
  }
  add(pose_at(0, {0.1, 0, 0}));
  EXPECT_NEAR(track_.speed(), 0, 1e-12);
}

// A motion is steady when it has gone on for some time.
TEST_F(PoseTracks, TellWhetherAMotionIsSteady) {
  for (int i = 0; i < 40; ++i) add(pose_at(0, {0, 0, 0}));
  int directed = 0, steady = 0;
  for (int i = 1; i <= 20; ++i) {
    add(pose_at(0, {0.01 * i, 0, 0}));
    directed += track_.pace(bound_, 0.1).is_directed() ? 1 : 0;
    steady += track_.pace(bound_, 0.1).is_steady() ? 1 : 0;
  }
  EXPECT_NEAR(directed, 19, 1);
  EXPECT_NEAR(steady, 13, 1);
}

}  // namespace
}  // namespace ist::test
