#include "ist/query/reference/reference_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "ist/base/error.h"
#include "ist/tree/sphere_tree.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// The surfaces in a contact are no farther apart than the resolution.
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
