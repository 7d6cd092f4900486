// Where a clearance found at an earlier pose answers, the interval of the distance still holds the
// true distance.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "query/pair_cache/motions.h"
#include "query/triangles/mesh_distance.h"
#include "query/triangles/triangle_tree.h"
#include "support/effort.h"

namespace ist::test {
namespace {

constexpr double kRounding = 1e-9;

struct ClearCounts {
  int clear = 0, lower = 0, upper = 0;  // answers, and those that tell more than the roots
};

// A query that keeps a cache, and the exact distance.
class ClearDistance : public ::testing::Test {
 protected:
  void make(const TriangleMesh& fixed, const TriangleMesh& moving, double cells, int workers = 1) {
    fixed_mesh_ = fixed;
    moving_mesh_ = moving;
    fixed_.emplace(triangle_tree(fixed, cells));
    moving_.emplace(triangle_tree(moving, cells));
    QueryOptions options;
    options.workers = workers;
    options.period = std::chrono::nanoseconds(0);
    exact_.emplace(*fixed_, *moving_, options);
    options.front_pairs = 1 << 14;
    kept_.emplace(*fixed_, *moving_, options);
    points_.emplace(*fixed_, *moving_, kept_->policy());
    wide_.emplace(*fixed_, *moving_, kept_->policy(), ManifoldOptions{.reach = 1});
  }

  // Asks at a pose and holds the interval, if there is one, against the truth.
  QueryResult tick(const Eigen::Isometry3d& pose, int verb) {
    const QueryResult result = verb == 0   ? kept_->leaf_pairs(pose, std::span<LeafPair>())
                               : verb == 1 ? kept_->contacts(pose, *points_)
                                           : kept_->contacts(pose, *wide_);
    if (!result.distance) return result;
    const DistanceInterval truth = exact_->distance(pose, 1e-6).distance;
    const DistanceInterval gap = *result.distance;
    EXPECT_LE(gap.lower, gap.upper);
    EXPECT_LE(gap.lower, truth.upper + kRounding) << to_string(result);
    EXPECT_GE(gap.upper, truth.lower - kRounding) << to_string(result);
    const bool by_roots = exact_->leaf_pairs(pose, std::span<LeafPair>()).found == Found::kClear;
    if (result.found != Found::kClear || by_roots) return result;
    ++counts_.clear;
    counts_.lower += gap.lower > 0 ? 1 : 0;
    counts_.upper += gap.upper < fixed_->bounding_radius() + moving_->bounding_radius() ? 1 : 0;
    return result;
  }
  static std::string to_string(const QueryResult& result) {
    return "found " + std::to_string(static_cast<int>(result.found));
  }
  [[nodiscard]] double voxel() const { return fixed_->voxel_size(); }

  TriangleMesh fixed_mesh_, moving_mesh_;
  std::optional<SphereTree> fixed_, moving_;
  std::optional<Query> exact_, kept_;
  std::optional<ContactManifold> points_, wide_;
  ClearCounts counts_;
};

TEST_F(ClearDistance, HoldsAlongMotionsOfAllSorts) {
  const TriangleMesh ball = icosphere(3, 1), block = box({-0.9, -0.7, -0.8}, {0.9, 0.7, 0.8});
  for (const int workers : {1, 2}) {
    make(ball, block, 24, workers);
    const Scene scene{"ball and block", *fixed_, *moving_, shift({0.5, 0.25, 0})};
    for (int run = 0; run < samples(60); ++run) {
      Random random(static_cast<std::uint64_t>(100 * workers + run));
      Motion motion(scene, random.below(1000));
      motion.limit_step(run % 2 == 0 ? 0.1 : 1);
      for (int i = 0; i < 80 && !HasFailure(); ++i) {
        tick(motion.next(), static_cast<int>(random.below(3)));
      }
    }
    if (workers == 2) continue;  // how often it is in time depends on the machine
    EXPECT_GT(counts_.clear, samples(100));
    EXPECT_GT(counts_.lower, samples(50));
    EXPECT_GT(counts_.upper, samples(50));
  }
}

// It tells more than the roots do.
TEST_F(ClearDistance, IsKnownToBodiesAtRest) {
  make(icosphere(3, 1), box({-0.9, -0.7, -0.8}, {0.9, 0.7, 0.8}), 24);
  const Eigen::Isometry3d pose = shift({1.9 + 0.3, 0, 0});
  QueryResult last;
  for (int i = 0; i < 30; ++i) last = tick(pose, 1);
  EXPECT_EQ(last.found, Found::kClear);
  EXPECT_GT(last.distance->lower, 0);
  EXPECT_LT(last.distance->upper, 1.6);
}

// Each clearance that comes true makes the next one wider, until the bodies can come nearer by most
// of a clearance, and are then closer together than the clearance was wide.
TEST_F(ClearDistance, IsLessByTheMotion) {
  make(icosphere(3, 1), box({-0.9, -0.7, -0.8}, {0.9, 0.7, 0.8}), 24);
  double gap = 0.05, known = 0;
  while (gap < 1 && known < 0.56 * gap) {
    gap += 0.005;
    known = tick(shift({1.9 + gap, 0, 0}), 1).distance->lower;
  }
  const double nearer = gap - 0.85 * known;
  ASSERT_LT(nearer, known);
  EXPECT_EQ(tick(shift({1.9 + nearer, 0, 0}), 1).found, Found::kClear);
}

// Two plates face to face that come apart at once: their roots still overlap, but no two leaves are
// near, and so no motion of what is near tells how far.
TEST_F(ClearDistance, HoldsWherePlatesComeApartAtOnce) {
  make(box({-5, -5, -0.1}, {5, 5, 0.1}), box({-5, -5, -0.1}, {5, 5, 0.1}), 40);
  for (const double away : {0.8, 2.0, 4.0, 6.0}) {
    for (const int verb : {0, 1, 2}) {
      SCOPED_TRACE(std::to_string(away) + ", verb " + std::to_string(verb));
      for (int i = 0; i < 20; ++i) tick(shift({0, 0, 0.8 + 0.0001 * i}), verb);
      tick(shift({0, 0, 0.2 + away}), verb);
      tick(shift({0, 0, 0.2 + away}), verb);
    }
  }
  EXPECT_GT(counts_.clear, 100);
}

// A rod that turns about its end moves most where it is far.
TEST_F(ClearDistance, HoldsWhereARodTurns) {
  const TriangleMesh rod = box({0, -0.1, -0.1}, {8, 0.1, 0.1});
  const TriangleMesh two =
      joined(box({-1, -1.5, -0.5}, {1, -0.6, 0.5}), box({6, -1.5, -0.5}, {8, -0.35, 0.5}));
  make(two, rod, 60);
  Random random(7);
  for (int round = 0; round < samples(60); ++round) {
    const Eigen::Vector3d axis = random.direction();
    const Eigen::Vector3d about(random.uniform(0, 8), 0, 0);
    const auto at = [&](double angle) {
      Eigen::Isometry3d pose = shift({0, random.uniform(0, 0.001), 0});
      pose.translate(about).rotate(Eigen::AngleAxisd(angle, axis)).translate(-about);
      return pose;
    };
    for (int i = 0; i < 8; ++i) tick(at(0), 1);
    for (int i = 0; i < 6; ++i) tick(at(std::pow(10, random.uniform(-3, 0))), 1);
  }
  EXPECT_GT(counts_.clear, samples(100));
}

}  // namespace
}  // namespace ist::test
