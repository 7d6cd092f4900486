#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/triangles/pair_list.h"
#include "query/triangles/meeting_pairs.h"
#include "query/triangles/triangle_tree.h"
#include "simd/guarded.h"
#include "simd/targets.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

std::vector<TrianglePair> ask_exact(Query& query, const Eigen::Isometry3d& pose) {
  std::vector<TrianglePair> pairs(1 << 16);
  const TrianglePairsResult result = query.triangle_pairs(pose, pairs);
  EXPECT_EQ(result.status, QueryStatus::kDone);
  EXPECT_FALSE(result.truncated);
  EXPECT_GE(result.sphere_tests, 1u);
  pairs.resize(result.triangle_pairs);
  return pairs;
}

void expect_exact(const SphereTree& fixed, const SphereTree& moving, const Eigen::Isometry3d& pose,
                  std::size_t& touching) {
  const std::vector<TrianglePair> wanted = meeting_pairs(fixed, moving, pose);
  const auto expect = [&](const QueryOptions& options) {
    Query query(fixed, moving, options);
    EXPECT_EQ(ask_exact(query, pose), wanted) << query.target();
    EXPECT_EQ(query.intersects(pose).answer, wanted.empty() ? ist::Answer::kNo : ist::Answer::kYes)
        << query.target();
  };
  QueryOptions options;
  for (const SpherePolicy policy : kSpherePolicies) {
    SCOPED_TRACE(to_string(policy));
    options.policy = policy;
    expect(options);
  }
  for (const std::string& target : all_targets()) {
    options.target = target;
    expect(options);
  }
  touching += wanted.empty() ? 0U : 1U;
}

TEST(TrianglePairs, OfRandomBodies) {
  std::size_t touching = 0, asked = 0;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{40}) && !::testing::Test::HasFailure();
       ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const SphereTree fixed = triangle_tree(a, random.uniform(1, 12)),
                     moving = triangle_tree(b, random.uniform(1, 12));
    for (int i = 0; i < 3; ++i) {
      const Eigen::Matrix3d rotation = random.rotation();
      const Eigen::Vector3d to = a.vertices[random.below(a.vertices.size())] -
                                 rotation * b.vertices[random.below(b.vertices.size())];
      expect_exact(fixed, moving,
                   pose_of(rotation, to + random.uniform(0, 0.2) * random.direction()), touching);
      ++asked;
    }
  }
  EXPECT_GT(touching, asked / 8);
  EXPECT_LT(touching, asked);
}

// Faces on faces, edges on edges, corners on corners.
TEST(TrianglePairs, OfBoxesOnOneLattice) {
  const TriangleMesh a = box({0, 0, 0}, {3, 3, 3}), b = box({0, 0, 0}, {2, 3, 1});
  const SphereTree fixed = triangle_tree(a, 3), moving = triangle_tree(b, 6);
  std::size_t touching = 0, asked = 0;
  for (const Eigen::Matrix3d& rotation : quarter_turns()) {
    for (const double x : {-3.0, 0.0, 1.0, 3.0, 4.0}) {
      expect_exact(fixed, moving, pose_of(rotation, {x, 1, -x}), touching);
      ++asked;
    }
  }
  EXPECT_GT(touching, asked / 4);
  EXPECT_LT(touching, asked);
}

TEST(TrianglePairs, OfABodyOnItself) {
  const SphereTree tree = triangle_tree(icosphere(1, 1), 9);
  std::size_t touching = 0;
  expect_exact(tree, tree, Eigen::Isometry3d::Identity(), touching);
  expect_exact(tree, tree, shift({0, 0, 0x1p-40}), touching);
  EXPECT_EQ(touching, 2u);
}

// Far from the meshes' origin the rounding of a moved vertex exceeds the error of leaves.
TEST(TrianglePairs, FarFromTheOrigin) {
  Random random(7);
  std::size_t touching = 0;
  for (const double place : {1e3, 1e6, 1e9}) {
    const Eigen::Vector3d away = place * Eigen::Vector3d(1, -0.7, 0.3);
    const TriangleMesh a = moved(icosphere(1, 1), away), b = box({-0.5, -0.4, -1}, {0.5, 0.4, 1});
    const SphereTree fixed = triangle_tree(a, 8), moving = triangle_tree(b, 11);
    for (int i = 0; i < samples(6); ++i) {
      expect_exact(fixed, moving,
                   pose_of(random.rotation(), away + random.uniform(0, 2) * random.direction()),
                   touching);
    }
  }
  EXPECT_GT(touching, samples(5u));
}

// Two bodies that touch in many triangles.
class ManyPairs : public ::testing::Test {
 protected:
  Query query_with(int workers = 1) const {
    QueryOptions options;
    options.workers = workers;
    options.period = std::chrono::nanoseconds(0);
    return Query(tree_, tree_, options);
  }
  const SphereTree tree_ = triangle_tree(icosphere(2, 1), 20);
  const Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  const std::vector<TrianglePair> wanted_ = meeting_pairs(tree_, tree_, pose_);
};

TEST_F(ManyPairs, WithOneWorkerAndWithTwo) {
  ASSERT_GT(wanted_.size(), 500u);
  for (const int workers : {1, 2}) {
    Query query = query_with(workers);
    EXPECT_EQ(ask_exact(query, pose_), wanted_) << workers;
    EXPECT_EQ(query.intersects(pose_).answer, ist::Answer::kYes);
    EXPECT_EQ(query.intersects(shift({3, 0, 0})).answer, ist::Answer::kNo);
  }
}

TEST_F(ManyPairs, SpansTooShortHoldTheFirst) {
  Query query = query_with();
  for (std::size_t length = 0; length < wanted_.size() + 40; length += length < 20 ? 1 : 211) {
    Guarded<TrianglePair> out(length, length % 8);
    const TrianglePairsResult result = query.triangle_pairs(pose_, out.span());
    ASSERT_EQ(result.triangle_pairs, wanted_.size());
    ASSERT_EQ(result.truncated, length < wanted_.size());
    const auto count = static_cast<std::ptrdiff_t>(std::min(length, wanted_.size()));
    ASSERT_TRUE(std::equal(wanted_.begin(), wanted_.begin() + count, out.data()));
    ASSERT_TRUE(out.intact());
  }
}

// A pose that is not rigid gives zero pairs. Bodies with separate roots give zero pairs after one
// test.
TEST_F(ManyPairs, OfWhatDoesNotTouchAreNone) {
  Query query = query_with();
  std::vector<TrianglePair> pairs(10);
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.matrix()(0, 0) = 2;
  EXPECT_EQ(query.triangle_pairs(bad, pairs).status, QueryStatus::kInvalidPose);
  const TrianglePairsResult far = query.triangle_pairs(shift({1e9, 0, 0}), pairs);
  EXPECT_EQ(far.status, QueryStatus::kDone);
  EXPECT_EQ(far.triangle_pairs, 0u);
  EXPECT_EQ(far.sphere_tests, 1u);
}

// One large triangle near many small ones, either way round.
TEST(TrianglePairs, OfAFewThatAreNearMany) {
  const TriangleMesh few = box({-2, -2, -1}, {2, 2, -0.999}), many = icosphere(4, 1);
  std::size_t touching = 0;
  expect_exact(triangle_tree(few, 20), triangle_tree(many, 20), shift({0.01, 0, 0}), touching);
  expect_exact(triangle_tree(many, 20), triangle_tree(few, 20), shift({0.01, 0, 0}), touching);
  EXPECT_EQ(touching, 2u);
}

TEST(TrianglePairs, WithoutTrianglesAreAStatus) {
  const SphereTree tree = tree_of(icosphere(1, 1), 9), exact = triangle_tree(icosphere(1, 1), 9);
  std::vector<TrianglePair> pairs(10);
  EXPECT_EQ(Query(tree, exact).triangle_pairs(shift({0, 0, 0}), pairs).status,
            QueryStatus::kNoTriangles);
}

TEST(Touches, WithoutTrianglesIsAtMostPossible) {
  const SphereTree tree = tree_of(icosphere(1, 1), 9), exact = triangle_tree(icosphere(1, 1), 9);
  Query query(tree, exact);
  EXPECT_FALSE(query.has_triangles());
  EXPECT_EQ(query.intersects(shift({0.1, 0, 0})).answer, ist::Answer::kNear);
  EXPECT_EQ(query.intersects(shift({3, 0, 0})).answer, ist::Answer::kNo);
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.matrix()(0, 0) = 2;
  EXPECT_EQ(query.intersects(bad).status, QueryStatus::kInvalidPose);
  EXPECT_EQ(Query(exact, exact).intersects(bad).status, QueryStatus::kInvalidPose);
}

// The voxels of either body are no part of an answer about triangles.
TEST(TrianglePairs, AreTheSameWithVoxelsAndWithout) {
  std::size_t touching = 0, asked = 0;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{40}); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const Eigen::Matrix3d rotation = random.rotation();
    const Eigen::Vector3d to = a.vertices[random.below(a.vertices.size())] -
                               rotation * b.vertices[random.below(b.vertices.size())];
    const Eigen::Isometry3d pose =
        pose_of(rotation, to + random.uniform(0, 0.2) * random.direction());
    const std::vector<TrianglePair> wanted = meeting_pairs(build_tree(a), build_tree(b), pose);
    for_voxels_or_none(a, b, 0.3, [&](const SphereTree& fixed, const SphereTree& moving) {
      for (const int workers : {1, 2}) {
        Query query(fixed, moving, {.workers = workers});
        EXPECT_EQ(query.workers(), workers);
        EXPECT_TRUE(query.has_triangles());
        EXPECT_EQ(ask_exact(query, pose), wanted);
        EXPECT_EQ(query.intersects(pose).answer,
                  wanted.empty() ? ist::Answer::kNo : ist::Answer::kYes);
        EXPECT_TRUE(query.intersects(pose).complete);
        std::vector<NearPair> near(1 << 16);
        const NearPairsResult found = query.near_pairs(pose, 0, near);
        EXPECT_EQ(found.status, QueryStatus::kDone);
        EXPECT_GE(found.near_pairs, wanted.size());
      }
    });
    touching += wanted.empty() ? 0U : 1U;
    ++asked;
  }
  EXPECT_GT(touching, asked / 8);
}

TEST(PairList, HoldsTheFirstPairsInOrder) {
  Random random(3);
  for (const std::size_t scratch : {0u, 70u, 5000u}) {
    PairList list(scratch);
    for (const std::uint32_t range : {4u, 300u, 70'000u, 4'000'000'000u}) {
      for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 700u, 3000u}) {
        std::vector<TrianglePair> wanted;
        for (std::size_t k = 0; k < count; ++k) {
          wanted.push_back({random.below(range), random.below(range)});
        }
        for (const std::size_t room : {0u, 1u, 64u, 699u, 700u, 4000u}) {
          Guarded<TrianglePair> out(room, 1);
          list.begin(out.span());
          for (const TrianglePair& pair : wanted) list.add(pair);
          list.finish();
          std::vector<TrianglePair> sorted = wanted;
          std::sort(sorted.begin(), sorted.end());
          ASSERT_EQ(list.count(), count);
          const auto kept = static_cast<std::ptrdiff_t>(std::min(room, count));
          ASSERT_TRUE(std::equal(sorted.begin(), sorted.begin() + kept, out.data()));
          ASSERT_TRUE(out.intact());
        }
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
