#include "ist/query/reference/reference_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ist/base/error.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/exact_query.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

ExactPolygon polygon(std::initializer_list<std::array<double, 3>> corners) {
  ExactPolygon result;
  for (const auto& [x, y, z] : corners) {
    result.push_back({mpq_class(x), mpq_class(y), mpq_class(z)});
  }
  return result;
}

bool meet(const ExactPolygon& a, const ExactPolygon& b) {
  EXPECT_EQ(polygons_meet(a, b), polygons_meet(b, a));
  return polygons_meet(a, b);
}

TEST(ExactPolygons, TouchingCountsAndTheLeastGapDoesNot) {
  const auto floor = polygon({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
  EXPECT_TRUE(meet(floor, polygon({{1, 1, -1}, {1, 1, 1}, {1, 2, 1}})));            // through
  EXPECT_TRUE(meet(floor, polygon({{1, 1, 0}, {1, 1, 1}, {1, 2, 1}})));             // corner in
  EXPECT_TRUE(meet(floor, polygon({{2, 2, 0}, {2, 2, 1}, {3, 3, 1}})));             // on edge
  EXPECT_TRUE(meet(floor, polygon({{4, 0, 0}, {5, 0, 1}, {5, 1, 1}})));             // corners
  EXPECT_FALSE(meet(floor, polygon({{1, 1, 0x1p-900}, {1, 1, 1}, {1, 2, 1}})));     // above
  EXPECT_FALSE(meet(floor, polygon({{2, 2 + 0x1p-50, 0}, {2, 3, 1}, {3, 3, 1}})));  // beside
  EXPECT_FALSE(meet(floor, polygon({{-0x1p-900, 0, 0}, {-1, 0, 1}, {-1, 1, 0}})));
}

TEST(ExactPolygons, InOnePlane) {
  const auto floor = polygon({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
  EXPECT_TRUE(meet(floor, polygon({{1, 1, 0}, {1.5, 1, 0}, {1, 1.5, 0}})));  // inside
  EXPECT_TRUE(meet(floor, polygon({{2, 2, 0}, {4, 4, 0}, {2, 4, 0}})));      // by a corner
  EXPECT_TRUE(meet(floor, polygon({{1, 0, 0}, {2, -1, 0}, {3, 0, 0}})));     // by an edge
  EXPECT_FALSE(meet(floor, polygon({{3, 3, 0}, {4, 4, 0}, {3, 4, 0}})));
}

TEST(ExactPolygons, FlatToSegmentsAndPoints) {
  const auto floor = polygon({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
  const auto segment = polygon({{1, 1, -1}, {1, 1, 1}, {1, 1, 0}});
  const auto point = polygon({{1, 1, 0}, {1, 1, 0}, {1, 1, 0}});
  EXPECT_TRUE(meet(floor, segment));
  EXPECT_TRUE(meet(floor, point));
  EXPECT_TRUE(meet(segment, point));
  EXPECT_TRUE(meet(point, point));
  EXPECT_TRUE(meet(segment, polygon({{0, 1, 0.5}, {2, 1, 0.5}})));
  EXPECT_TRUE(meet(segment, polygon({{1, 1, 1}, {1, 1, 3}})));
  EXPECT_FALSE(meet(segment, polygon({{1, 1, 1.5}, {1, 1, 3}})));
  EXPECT_FALSE(meet(segment, polygon({{0, 1.5, 0.5}, {2, 1.5, 0.5}})));
  EXPECT_FALSE(meet(point, polygon({{1, 1, 0x1p-1000}})));
  EXPECT_FALSE(meet(floor, {}));
}

TEST(ExactPolygons, ClippingKeepsWhatLiesOnTheBox) {
  const ExactBox unit{{0, 0, 0}, {1, 1, 1}};
  const auto cut = clip(polygon({{-1, 0.5, 1}, {3, 0.5, 1}, {1, 0.5, -1}}), unit);
  EXPECT_FALSE(cut.empty());
  for (const ExactPoint& p : cut) {
    for (const mpq_class& x : p.coordinates) EXPECT_TRUE(x >= 0 && x <= 1);
  }
  EXPECT_EQ(clip(polygon({{1, 1, 1}, {2, 1, 1}, {1, 2, 1}}), unit).front(), (ExactPoint{1, 1, 1}));
  EXPECT_TRUE(clip(polygon({{1 + 0x1p-52, 0, 0}, {2, 0, 0}, {2, 1, 0}}), unit).empty());
}

// Each body is one voxel with an edge of 1, so every number of the oracle is known.
class OneVoxelPair : public ::testing::Test {
 protected:
  const TriangleMesh mesh_ = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 1});
  const SphereTree tree_ = tree_of(mesh_, 1);
  const ExactBody body_{mesh_, tree_};
  [[nodiscard]] bool cubes_meet(const Eigen::Isometry3d& pose) const {
    const ExactPair pair(body_, body_, pose);
    const bool meets = pair.geometry_meets(SpherePolicy::kSimple, 0, 0);
    EXPECT_EQ(meets, pair.geometry_meets(SpherePolicy::kTable, 0, 0));
    return meets;
  }
};

TEST_F(OneVoxelPair, CubesTouchByFaceEdgeAndCorner) {
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, -1),
                                    Eigen::Vector3d(-1, 1, 1), Eigen::Vector3d(0.5, 1, 0)}) {
    EXPECT_TRUE(cubes_meet(shift(at)));
    EXPECT_FALSE(cubes_meet(shift(at * (1 + 0x1p-52))));
  }
}

TEST_F(OneVoxelPair, CubesThatOnlyAnEdgeAxisSeparates) {
  // Two edges cross at right angles: one cube turned about z, the other about x, by 3-4-5.
  Eigen::Matrix3d about_z, about_x;
  about_z << 0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1;
  about_x << 1, 0, 0, 0, 0.6, -0.8, 0, 0.8, 0.6;
  Random random(7);
  int meeting = 0, apart = 0;
  for (int i = 0; i < samples(400); ++i) {
    const Eigen::Isometry3d pose = pose_of(about_z * about_x, random.point(-1.5, 1.5));
    // Points of one cube, as a fine grid. One of them in the other cube proves that they meet.
    bool sampled = false;
    for (int s = 0; s < 9 * 9 * 9 && !sampled; ++s) {
      const Eigen::Vector3d p = pose * Eigen::Vector3d(s % 9 / 8.0, s / 9 % 9 / 8.0, s / 81 / 8.0);
      sampled = p.minCoeff() >= 0 && p.maxCoeff() <= 1;
    }
    const bool meets = cubes_meet(pose);
    EXPECT_TRUE(meets || !sampled);
    (meets ? meeting : apart) += 1;
  }
  EXPECT_GT(meeting, samples(25));
  EXPECT_GT(apart, samples(25));
}

TEST_F(OneVoxelPair, BoundsMeetToTheLastBit) {
  const Eigen::Vector3d diagonal(1, 1, 1);  // √3 apart: circumspheres touch in a point
  EXPECT_TRUE(ExactPair(body_, body_, shift(diagonal)).bounds_meet(SpherePolicy::kTable, 0, 0, 0));
  const Eigen::Vector3d beyond(1, 1, 1 + 0x1p-50);
  const ExactPair pair(body_, body_, shift(beyond));
  EXPECT_FALSE(pair.bounds_meet(SpherePolicy::kTable, 0, 0, 0));
  EXPECT_FALSE(pair.bounds_meet(SpherePolicy::kTable, 0, 0, 0x1p-51));
  EXPECT_TRUE(pair.bounds_meet(SpherePolicy::kTable, 0, 0, 0x1p-50));
  EXPECT_FALSE(
      ExactPair(body_, body_, shift(diagonal)).bounds_meet(SpherePolicy::kTable, 0, 0, -0x1p-60));
}

// Two squares, one over the other: heights over either's slab, and balls that reach farther.
TEST(ExactPairs, SlabsMeetToTheLastBit) {
  const TriangleMesh square = open_strip(1);
  const SphereTree tree = tree_of(square, 1);
  const ExactBody body(square, tree);
  const Slab slab = voxels_of(tree).saved_slab(0, 0, 0);
  ASSERT_EQ(slab.normal.cwiseAbs(), Eigen::Vector3d(0, 0, 126.0 / 128));
  ASSERT_EQ(slab.offset, 0);
  const mpq_class reach =
      mpq_class(slab.half) + mpq_class(voxels_of(tree).saved_ball(0, 0, 0).radius);
  for (const double pad : {0.0, 0x1p-20, -0x1p-20}) {
    const auto meet = [&](SpherePolicy policy, double gap) {
      const ExactPair above(body, body, shift({0, 0, gap})), below(body, body, shift({0, 0, -gap}));
      const bool meets = above.bounds_meet(policy, 0, 0, pad);
      EXPECT_EQ(below.bounds_meet(policy, 0, 0, pad), meets);
      return meets;
    };
    const double last =
        last_touching(0, 2, [&](double gap) { return meet(SpherePolicy::kSlab, gap); });
    EXPECT_LE(126 * mpq_class(last) / 128, reach + mpq_class(pad));
    EXPECT_GT(126 * mpq_class(std::nextafter(last, 2)) / 128, reach + mpq_class(pad));
    EXPECT_TRUE(meet(SpherePolicy::kTight, last + 0.5));
  }
}

TEST_F(OneVoxelPair, TheGuaranteeIsCheckedBothWays) {
  const std::vector<LeafPair> none, one{{0, 0}}, twice{{0, 0}, {0, 0}}, strange{{0, 0}, {0, 1}};
  for (const SpherePolicy policy : kSpherePolicies) {
    const ExactPair touching(body_, body_, Eigen::Isometry3d::Identity());
    EXPECT_TRUE(keeps_guarantee(touching, policy, one, 0));
    EXPECT_FALSE(keeps_guarantee(touching, policy, none, 0));
    EXPECT_FALSE(keeps_guarantee(touching, policy, twice, 0));
    EXPECT_FALSE(keeps_guarantee(touching, policy, strange, 0));
    const ExactPair apart(body_, body_, shift({3, 0, 0}));
    EXPECT_TRUE(keeps_guarantee(apart, policy, none, 0));
    EXPECT_FALSE(keeps_guarantee(apart, policy, one, 0));
  }
}

// The distance between the surfaces of a contact is at most the resolution.
TEST(Reference, ResolutionBoundsTheDistanceOfSurfaces) {
  const TriangleMesh left = box({0, 0, 0}, {1, 1, 1}), right = box({0, 0, 0}, {1, 1, 1});
  const SphereTree fixed = tree_of(left, 5), moving = tree_of(right, 3);
  for (const SpherePolicy policy : kSpherePolicies) {
    ReferenceQuery query(fixed, moving, policy);
    const double last = last_touching(1, 4, [&](double x) {
      return ask(query, shift({x, 0, 0})).result.leaf_pairs > 0;
    });
    const QueryResult result = ask(query, shift({last, 0, 0})).result;
    EXPECT_LE(last - 1, result.resolution);
    EXPECT_GE(result.resolution, result.pad);
    EXPECT_GT(result.pad, 0);
    EXPECT_LT(result.pad, 1e-13);
  }
}

// Two bodies that overlap over many voxels, at poses that bring their surfaces together.
class ReferenceOfBalls : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  static Eigen::Isometry3d some_pose(std::uint64_t seed) {
    Random random(seed);
    const Eigen::Matrix3d rotation = random.rotation();
    return pose_of(rotation, random.uniform(1.2, 1.9) * random.direction());
  }

  const SphereTree fixed_ = tree_of(moved(icosphere(2, 1), {0.25, 0.5, 0.125}), 16);
  const SphereTree moving_ = tree_of(icosphere(2, 0.75), 12);
  ReferenceQuery query_{fixed_, moving_, GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Policies, ReferenceOfBalls, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(ReferenceOfBalls, MirrorsThePairsOfSwappedBodies) {
  ReferenceQuery swapped(moving_, fixed_, GetParam());
  std::size_t leaf_pairs = 0;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{20}); ++seed) {
    const Eigen::Isometry3d pose = some_pose(seed);
    const FoundPairs answer = ask(query_, pose);
    FoundPairs mirrored = ask(swapped, pose.inverse());
    for (LeafPair& pair : mirrored.leaf_pairs) std::swap(pair.fixed, pair.moving);
    std::sort(mirrored.leaf_pairs.begin(), mirrored.leaf_pairs.end());
    EXPECT_EQ(mirrored.leaf_pairs, answer.leaf_pairs) << "seed " << seed;
    EXPECT_EQ(mirrored.result.sphere_tests, answer.result.sphere_tests);
    leaf_pairs += answer.leaf_pairs.size();
  }
  EXPECT_GT(leaf_pairs, samples(100u));
}

TEST_P(ReferenceOfBalls, AnswersTheSameFromEitherSourceOfSpheres) {
  ReferenceQuery saved(fixed_, moving_, GetParam(), SphereSource::kSaved);
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{10}); ++seed) {
    EXPECT_TRUE(same(ask(saved, some_pose(seed)), ask(query_, some_pose(seed))));
  }
}

TEST(Reference, BoundsThatAreNotThereAreRefused) {
  BuildOptions options;
  options.voxel_size = 0.5;
  options.spheres = SpherePolicy::kTable;
  const SphereTree table = build_tree(icosphere(1, 1), options);
  options.spheres = SpherePolicy::kTight;
  const SphereTree tight = build_tree(icosphere(1, 1), options);
  const SphereTree slab = tree_of(icosphere(1, 1), 4);
  EXPECT_THROW(ReferenceQuery(slab, table, SpherePolicy::kTight), Error);
  EXPECT_THROW(ReferenceQuery(table, slab, SpherePolicy::kTight), Error);
  EXPECT_THROW(ReferenceQuery(slab, tight, SpherePolicy::kSlab), Error);
  EXPECT_THROW(ReferenceQuery(tight, slab, SpherePolicy::kSlab), Error);
  EXPECT_NO_THROW(ReferenceQuery(table, slab, SpherePolicy::kTable));
  EXPECT_NO_THROW(ReferenceQuery(slab, tight, SpherePolicy::kTight));
}

// Two flat sheets face to face, a voxel's edge apart. A leaf's ball reaches 0.71 edges: as far as
// the other sheet's balls, but not to its slabs.
TEST(Reference, SlabsTellSheetsApartThatBallsDoNot) {
  const TriangleMesh sheet = joined(open_strip(2), moved(open_strip(2), {0, 1, 0}));
  const SphereTree tree = tree_of(sheet, 8);
  const double gap = tree.voxel_size();
  ReferenceQuery tight(tree, tree, SpherePolicy::kTight), slab(tree, tree, SpherePolicy::kSlab);
  const FoundPairs balls = ask(tight, shift({0, 0, gap})), slabs = ask(slab, shift({0, 0, gap}));
  EXPECT_GT(balls.result.leaf_pairs, 64u);
  EXPECT_EQ(slabs.result.leaf_pairs, 0u);
  EXPECT_LE(slabs.result.sphere_tests, balls.result.sphere_tests);
  EXPECT_GT(ask(slab, shift({0, 0, 0})).result.leaf_pairs, 0u);
}

}  // namespace
}  // namespace ist::test
