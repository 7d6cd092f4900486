// How far a motion brings two bodies nearer each other is bounded, and not by more than the box in
// which they can be near moves.

#include "ist/query/pair_cache/motion_bound.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "ist/tree/tree_parts.h"
#include "query/pair_cache/cache_case.h"
#include "simd/lanes.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

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
  const auto parents = static_cast<std::uint32_t>(parts_of(tree).octree.nodes(1).size() - 1);
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

// A turn about where the bodies touch moves less there than at their far ends.
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

// Where lengths cannot be told from each other, what they differ by is not lost in rounding.
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
  // Nothing holds where it is no number, which fails each comparison by <=.
  const RelativePose farthest{Eigen::Matrix3d::Identity(), {1e300, 1e300, 0}},
      here{Eigen::Matrix3d::Identity(), {0, 0, 0}};
  EXPECT_FALSE(bound.between(farthest, here, 1) <= 1);
}

}  // namespace
}  // namespace ist::test
