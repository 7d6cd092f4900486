#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "ist/query/reference/reference_query.h"
#include "query/query_cases.h"
#include "support/exact_query.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// A span between guards, filled with what no query writes.
class GuardedSpan {
 public:
  static constexpr LeafPair kGuard{0xDEADBEEF, 0xCAFEF00D};
  explicit GuardedSpan(std::size_t size) : leaf_pairs_(size + 16, kGuard) {}
  [[nodiscard]] std::span<LeafPair> span() {
    return {leaf_pairs_.data() + 8, leaf_pairs_.size() - 16};
  }
  [[nodiscard]] bool intact() const {
    return std::all_of(leaf_pairs_.begin(), leaf_pairs_.begin() + 8, is_guard) &&
           std::all_of(leaf_pairs_.end() - 8, leaf_pairs_.end(), is_guard);
  }
  [[nodiscard]] bool untouched() const {
    return std::all_of(leaf_pairs_.begin(), leaf_pairs_.end(), is_guard);
  }

 private:
  static bool is_guard(const LeafPair& pair) { return pair == kGuard; }
  std::vector<LeafPair> leaf_pairs_;
};

bool same(const FoundPairs& a, const FoundPairs& b) {
  return a.leaf_pairs == b.leaf_pairs && a.result.status == b.result.status &&
         a.result.complete == b.result.complete && a.result.truncated == b.result.truncated &&
         a.result.level == b.result.level && a.result.leaf_pairs == b.result.leaf_pairs &&
         a.result.sphere_tests == b.result.sphere_tests && a.result.pad == b.result.pad;
}

// Two bodies that overlap over many voxels, with coordinates of few bits.
class ReferenceInvariance : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  static TriangleMesh coarse(TriangleMesh mesh) {
    for (Eigen::Vector3d& vertex : mesh.vertices) {
      for (double& x : vertex) x = std::nearbyint(x * 0x1p20) * 0x1p-20;
    }
    return mesh;
  }
  static TriangleMesh scaled(TriangleMesh mesh, double factor) {
    for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= factor;
    return mesh;
  }
  static Eigen::Isometry3d some_pose(std::uint64_t seed) {
    Random random(seed);
    const Eigen::Matrix3d rotation = random.rotation();
    return pose_of(rotation, random.uniform(1.2, 1.9) * random.direction());
  }

  const TriangleMesh a_ = coarse(moved(icosphere(2, 1), {0.25, 0.5, 0.125}));
  const TriangleMesh b_ = coarse(icosphere(2, 0.75));
  const SphereTree fixed_ = tree_of(a_, 16), moving_ = tree_of(b_, 12);
  ReferenceQuery query_{fixed_, moving_, GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Policies, ReferenceInvariance, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(ReferenceInvariance, PowersOfTwoScaleLengthsAndChangeNothingElse) {
  for (const int k : {-20, -7, -1, 1, 3, 20}) {
    const double factor = std::ldexp(1.0, k);
    const SphereTree fixed = tree_of(scaled(a_, factor), 16);
    const SphereTree moving = tree_of(scaled(b_, factor), 12);
    ReferenceQuery scaled_query(fixed, moving, GetParam());
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      Eigen::Isometry3d pose = some_pose(seed);
      const FoundPairs plain = ask(query_, pose);
      pose.translation() *= factor;
      const FoundPairs answer = ask(scaled_query, pose);
      EXPECT_EQ(answer.leaf_pairs, plain.leaf_pairs);
      EXPECT_EQ(answer.result.sphere_tests, plain.result.sphere_tests);
      EXPECT_EQ(answer.result.pad, factor * plain.result.pad);
      EXPECT_EQ(answer.result.resolution, factor * plain.result.resolution);
    }
  }
}

TEST_P(ReferenceInvariance, SwappedBodiesGiveThePairsMirrored) {
  ReferenceQuery swapped(moving_, fixed_, GetParam());
  std::size_t leaf_pairs = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Eigen::Isometry3d pose = some_pose(seed);
    const FoundPairs answer = ask(query_, pose);
    FoundPairs mirrored = ask(swapped, pose.inverse());
    for (LeafPair& pair : mirrored.leaf_pairs) std::swap(pair.fixed, pair.moving);
    std::sort(mirrored.leaf_pairs.begin(), mirrored.leaf_pairs.end());
    EXPECT_EQ(mirrored.leaf_pairs, answer.leaf_pairs) << "seed " << seed;
    EXPECT_EQ(mirrored.result.sphere_tests, answer.result.sphere_tests);
    leaf_pairs += answer.leaf_pairs.size();
  }
  EXPECT_GT(leaf_pairs, 100u);
}

TEST_P(ReferenceInvariance, ThePlaceOfTheSceneDoesNotMatter) {
  const Eigen::Vector3d away(1024, -4096, 65536);
  const SphereTree far_fixed = tree_of(moved(a_, away), 16);
  const SphereTree far_moving = tree_of(moved(b_, away), 12);
  ReferenceQuery fixed_moved(far_fixed, moving_, GetParam());
  ReferenceQuery both_moved(far_fixed, far_moving, GetParam());
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Eigen::Isometry3d pose = some_pose(seed);
    for (double& x : pose.translation()) x = std::nearbyint(x * 0x1p20) * 0x1p-20;
    const FoundPairs answer = ask(query_, pose);
    EXPECT_EQ(ask(fixed_moved, pose_of(pose.linear(), pose.translation() + away)).leaf_pairs,
              answer.leaf_pairs);
    const Eigen::Isometry3d straight = shift(pose.translation());
    EXPECT_EQ(ask(both_moved, straight).leaf_pairs, ask(query_, straight).leaf_pairs);
  }
}

TEST_P(ReferenceInvariance, AShortSpanHoldsTheFirstContacts) {
  const Eigen::Isometry3d pose = some_pose(1);
  const FoundPairs all = ask(query_, pose);
  const std::size_t count = all.leaf_pairs.size();
  ASSERT_GT(count, 20u);
  EXPECT_FALSE(all.result.truncated);
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{7}, count - 1, count, count + 1, 2 * count}) {
    GuardedSpan guarded(size);
    const QueryResult result = query_.leaf_pairs(pose, guarded.span());
    const std::size_t written = std::min(size, count);
    EXPECT_TRUE(std::equal(all.leaf_pairs.begin(),
                           all.leaf_pairs.begin() + static_cast<std::ptrdiff_t>(written),
                           guarded.span().begin()));
    EXPECT_TRUE(std::all_of(guarded.span().begin() + static_cast<std::ptrdiff_t>(written),
                            guarded.span().end(),
                            [](const LeafPair& c) { return c == GuardedSpan::kGuard; }));
    EXPECT_TRUE(guarded.intact());
    EXPECT_EQ(result.truncated, size < count);
    EXPECT_EQ(result.leaf_pairs, count);
    EXPECT_EQ(result.sphere_tests, all.result.sphere_tests);
    EXPECT_TRUE(result.complete);
  }
}

TEST_P(ReferenceInvariance, EveryTimeAndFromEverySourceTheSame) {
  ReferenceQuery saved(fixed_, moving_, GetParam(), SphereSource::kSaved);
  std::vector<FoundPairs> first;
  for (std::uint64_t seed = 0; seed < 10; ++seed) first.push_back(ask(query_, some_pose(seed)));
  for (int round = 0; round < 3; ++round) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      EXPECT_TRUE(same(ask(query_, some_pose(seed)), first[seed]));
      EXPECT_TRUE(same(ask(saved, some_pose(seed)), first[seed]));
    }
  }
}

TEST_P(ReferenceInvariance, PosesThatAreNoRigidMotionsGiveAStatus) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 16; ++i) {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
      poses.push_back(Eigen::Isometry3d::Identity());
      poses.back().matrix().data()[i] = bad;
    }
  }
  const auto add = [&poses](const Eigen::Matrix3d& linear) {
    poses.push_back(pose_of(linear, {0, 0, 0}));
  };
  add(Eigen::Matrix3d::Zero());
  add(-Eigen::Matrix3d::Identity());
  add(Eigen::Vector3d(1, 1, -1).asDiagonal());
  add(1.001 * Eigen::Matrix3d::Identity());
  add(Eigen::Matrix3d::Constant(1e200));
  for (int column = 0; column < 4; ++column) {
    poses.push_back(Eigen::Isometry3d::Identity());
    poses.back().matrix()(3, column) = 0.5;
  }
  for (const Eigen::Isometry3d& pose : poses) {
    GuardedSpan guarded(64);
    const QueryResult result = query_.leaf_pairs(pose, guarded.span());
    EXPECT_EQ(result.status, QueryStatus::kInvalidPose) << pose.matrix();
    EXPECT_FALSE(result.complete);
    EXPECT_FALSE(result.truncated);
    EXPECT_EQ(result.leaf_pairs, 0u);
    EXPECT_EQ(result.sphere_tests, 0u);
    EXPECT_TRUE(guarded.untouched());
  }
  // And the next one is answered as if nothing had been.
  EXPECT_GT(ask(query_, Eigen::Isometry3d::Identity()).result.leaf_pairs, 0u);
}

TEST_P(ReferenceInvariance, ARotationThatIsNearlyOneIsProjected) {
  const Eigen::Isometry3d pose = some_pose(2);
  Eigen::Isometry3d rough = pose;
  rough.linear() *= 1 + 3e-6;
  const FoundPairs answer = ask(query_, rough);
  EXPECT_EQ(answer.result.status, QueryStatus::kDone);
  EXPECT_EQ(answer.leaf_pairs, ask(query_, pose).leaf_pairs);
}

TEST_P(ReferenceInvariance, TheCallersRoundingChangesNothingAndComesBack) {
  constexpr unsigned kDefault = 0x1F80, kFlushToZero = 0x8000, kDenormalsAreZero = 0x40;
  const Eigen::Isometry3d pose = some_pose(3);
  const FoundPairs plain = ask(query_, pose);
  std::vector<LeafPair> leaf_pairs(plain.leaf_pairs.size());
  const unsigned before = _mm_getcsr();
  for (const unsigned rounding : {0x2000u, 0x4000u, 0x6000u}) {
    const unsigned mode = kDefault | rounding | kFlushToZero | kDenormalsAreZero;
    _mm_setcsr(mode);
    const QueryResult result = query_.leaf_pairs(pose, leaf_pairs);
    const unsigned after = _mm_getcsr();
    _mm_setcsr(before);
    EXPECT_EQ(after, mode);
    EXPECT_TRUE(same({result, leaf_pairs}, plain));
  }
}

}  // namespace
}  // namespace ist::test
