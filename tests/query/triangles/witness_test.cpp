#include <gtest/gtest.h>

#include <vector>

#include "ist/query/inside.h"
#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"
#include "query/triangles/triangle_tree.h"
#include "simd/targets.h"
#include "support/conformal.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// A body that goes in and out of another by small steps, and sometimes leaps.
class Witness : public ::testing::Test {
 protected:
  static std::vector<Eigen::Isometry3d> way() {
    Random random(3);
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < 160; ++i) {
      const double along = i % 40 < 20 ? 1.77 - 0.004 * (i % 20) : 1.694 + 0.004 * (i % 20);
      const Eigen::Vector3d leap = i % 23 == 22 ? random.point(-1, 1) : random.point(-0.001, 0.001);
      poses.push_back(pose_of(random.rotation(), Eigen::Vector3d(along, 0.1, 0) + leap));
      if (i % 5 > 0) poses.back().linear() = Eigen::Matrix3d::Identity();
    }
    return poses;
  }
  const SphereTree fixed_ = triangle_tree(icosphere(4, 1), 12);
  const SphereTree moving_ = triangle_tree(moved(icosphere(4, 0.8), {0.05, 0, 0.02}), 12);
};

TEST_F(Witness, ChangesNoAnswerButTheEndsOfADistance) {
  constexpr double kTolerance = 0.02;
  Query query(fixed_, moving_);
  std::vector<TrianglePair> a(1 << 14), b = a;
  std::size_t meeting = 0, at_once = 0, other_ends = 0;
  for (const Eigen::Isometry3d& pose : way()) {
    Query fresh(fixed_, moving_);
    const IntersectionResult met = query.intersects(pose), wanted = fresh.intersects(pose);
    EXPECT_EQ(met.answer, wanted.answer);
    meeting += met.answer == Answer::kYes ? 1U : 0U;
    at_once += met.answer == Answer::kYes && met.sphere_tests == 2 ? 1U : 0U;
    a.resize(1 << 14);
    b.resize(1 << 14);
    a.resize(query.triangle_pairs(pose, a).triangle_pairs);
    b.resize(fresh.triangle_pairs(pose, b).triangle_pairs);
    EXPECT_EQ(a, b);
    fresh.forget();
    const DistanceInterval gap = query.distance(pose, kTolerance).distance;
    const DistanceInterval of_fresh = fresh.distance(pose, kTolerance).distance;
    const DistanceInterval truth = fresh.distance(pose, 0).distance;
    EXPECT_LE(gap.lower, truth.lower);
    EXPECT_GE(gap.upper, truth.upper);
    EXPECT_LE(gap.upper - gap.lower, kTolerance);
    other_ends += gap.upper != of_fresh.upper ? 1U : 0U;
    // Without a tolerance the ends of the distance do not depend on earlier questions.
    const DistanceInterval sharp = query.distance(pose, 0).distance;
    EXPECT_EQ(sharp.lower, truth.lower);
    EXPECT_EQ(sharp.upper, truth.upper);
  }
  EXPECT_GT(meeting, 40u);
  EXPECT_GT(at_once, 20u);
  EXPECT_GT(other_ends, 0u);
}

TEST_F(Witness, IsForgotten) {
  std::vector<DistanceResult> of_new;
  for (const Eigen::Isometry3d& pose : way()) {
    of_new.push_back(Query(fixed_, moving_).distance(pose, 0.05));
  }
  for (const int workers : {1, 2}) {
    for (const std::string& target : all_targets()) {
      Query query(fixed_, moving_, {.target = target, .workers = workers});
      std::size_t at = 0;
      for (const Eigen::Isometry3d& pose : way()) {
        query.forget();
        const DistanceResult a = query.distance(pose, 0.05), b = of_new[at++];
        ASSERT_EQ(a.distance.lower, b.distance.lower) << target;
        ASSERT_EQ(a.distance.upper, b.distance.upper) << target;
        ASSERT_EQ(a.sphere_tests, b.sphere_tests) << target;
      }
    }
  }
}

TEST_F(Witness, IsIgnoredWhereTestsAreLimited) {
  Query query(fixed_, moving_);
  Budget budget;
  budget.tests = 5000;
  for (const Eigen::Isometry3d& pose : way()) {
    Query fresh(fixed_, moving_);
    static_cast<void>(query.distance(pose, 0.05));
    const DistanceResult a = query.distance(pose, 0.05, budget);
    const DistanceResult b = fresh.distance(pose, 0.05, budget);
    ASSERT_EQ(a.distance.lower, b.distance.lower);
    ASSERT_EQ(a.distance.upper, b.distance.upper);
    static_cast<void>(query.intersects(pose));  // leaves a witness if they meet
    ASSERT_EQ(query.intersects(pose, budget).sphere_tests,
              Query(fixed_, moving_).intersects(pose, budget).sphere_tests);
  }
}

// Forgets the pairs of a pair cache too, also while the worker makes the next one.
TEST_F(Witness, IsForgottenWithACache) {
  for (const int workers : {1, 2}) {
    QueryOptions options{.workers = workers, .period = {}, .front_pairs = 1 << 14};
    Query query(fixed_, moving_, options), fresh(fixed_, moving_);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Isometry3d pose = shift({1.6 + 0.0001 * i, 0.1, 0});
      if (i % 7 == 6) {
        query.forget();
        EXPECT_NE(query.leaf_pairs(pose, {}).found, Found::kKept);
      }
      const FoundPairs a = ask(query, pose), b = ask(fresh, pose);
      ASSERT_EQ(a.leaf_pairs, b.leaf_pairs);
    }
  }
}

// The pair that was nearest from afar is a bad begin: no search may take much longer for it.
TEST_F(Witness, CostsLittleAfterALeap) {
  Query query(fixed_, moving_);
  Query fresh(fixed_, moving_);
  const Eigen::Isometry3d near(Eigen::Translation3d(1.8, 0.1, 0));
  for (const Eigen::Vector3d& far : {Eigen::Vector3d(0, 0, 40), Eigen::Vector3d(-9, 0, 0),
                                     Eigen::Vector3d(0, 300, 0), Eigen::Vector3d(-1.85, 0, 0)}) {
    for (const double tolerance : {0.0, 0.01}) {
      static_cast<void>(query.distance(Eigen::Isometry3d(Eigen::Translation3d(far)), tolerance));
      fresh.forget();
      const std::uint64_t tests = query.distance(near, tolerance).sphere_tests;
      EXPECT_LE(tests, 3 * fresh.distance(near, tolerance).sphere_tests) << far.transpose();
    }
  }
}

constexpr double kVoxelSize = 0.25;

SphereTree triangle_tree_of(const TriangleMesh& mesh) {
  BuildOptions options;
  options.voxel_size = kVoxelSize;
  options.keep_triangles = true;
  BuildReport report;
  SphereTree tree = build_tree(mesh, options, &report);
  EXPECT_EQ(report.turned_components, 0u);
  return tree;
}

// Conformal surfaces have the most pairs. The answer is as certain.
TEST(Conformal, TheGapIsKnownAtAnyTime) {
  for (const ConformalPair& pair : conformal_pairs(3, 4, 0.3)) {
    SCOPED_TRACE(pair.name);
    const SphereTree fixed = triangle_tree_of(pair.fixed), moving = triangle_tree_of(pair.moving);
    Query query(fixed, moving);
    const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const DistanceResult gap = query.distance(pose, 0);
    EXPECT_NEAR(gap.distance.lower, pair.gap, 0.01 * pair.gap);
    EXPECT_NEAR(gap.distance.upper, pair.gap, 0.01 * pair.gap);
    EXPECT_EQ(query.intersects(pose).answer, ist::Answer::kNo);
    EXPECT_EQ(InsideTest(pair.fixed, pair.moving).at(pose),
              pair.name == "shells" || pair.name == "inside" ? Inside::kMoving : Inside::kNone);
    std::vector<LeafPair> leaf_pairs(1 << 20);
    for (const std::uint64_t tests : {1u, 100u, 10'000u, 100'000'000u}) {
      const QueryResult result = query.leaf_pairs(pose, leaf_pairs, {.tests = tests});
      EXPECT_LE(result.distance->lower, 1.01 * pair.gap);
      EXPECT_GE(result.distance->upper, 0.99 * pair.gap);
    }
  }
}

}  // namespace
}  // namespace ist::test
