// What holds of leaf pairs whatever engine finds them.

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "query/engines.h"
#include "simd/guarded.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Two bodies that overlap over many voxels, with coordinates of few bits.
class EveryEngine : public ::testing::TestWithParam<Engine> {
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
  const TriangleMesh b_ = coarse(box({-0.9, -0.7, -0.8}, {0.9, 0.7, 0.8}));
  const SphereTree fixed_ = tree_of(a_, 16), moving_ = tree_of(b_, 17);
  EngineQuery query_{fixed_, moving_, GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Engines, EveryEngine, ::testing::ValuesIn(engines_of(all_targets())),
                         engine_name);

TEST_P(EveryEngine, AnswersTheSameEveryTime) {
  std::vector<FoundPairs> first;
  const auto seeds = samples(std::uint64_t{10});
  for (std::uint64_t seed = 0; seed < seeds; ++seed) first.push_back(ask(query_, some_pose(seed)));
  for (int round = 0; round < 3; ++round) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      EXPECT_TRUE(same(ask(query_, some_pose(seed)), first[seed]));
    }
  }
}

// A scene that is a power of two times as large gives the same numbers.
TEST_P(EveryEngine, DoesNotKnowTheUnit) {
  std::size_t leaf_pairs = 0;
  for (const int k : {-38, -20, -9, -7, -1, 1, 3, 20, 48}) {
    const double unit = std::ldexp(1.0, k);
    const SphereTree fixed = tree_of(scaled(a_, unit), 16), moving = tree_of(scaled(b_, unit), 17);
    EngineQuery query(fixed, moving, GetParam());
    for (std::uint64_t seed = 0; seed < samples(std::uint64_t{8}); ++seed) {
      Eigen::Isometry3d pose = some_pose(seed);
      const FoundPairs expected = ask(query_, pose);
      pose.translation() *= unit;
      FoundPairs answer = ask(query, pose);
      answer.result.pad /= unit;
      EXPECT_TRUE(same(answer, expected)) << unit;
      EXPECT_EQ(answer.result.resolution, unit * expected.result.resolution);
      leaf_pairs += answer.leaf_pairs.size();
    }
  }
  EXPECT_GT(leaf_pairs, 9 * samples(100u));
}

TEST_P(EveryEngine, DoesNotKnowThePlaceOfTheScene) {
  const Eigen::Vector3d away(1024, -4096, 65536);
  const SphereTree far_fixed = tree_of(moved(a_, away), 16);
  const SphereTree far_moving = tree_of(moved(b_, away), 17);
  EngineQuery fixed_moved(far_fixed, moving_, GetParam());
  EngineQuery both_moved(far_fixed, far_moving, GetParam());
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{20}); ++seed) {
    Eigen::Isometry3d pose = some_pose(seed);
    for (double& x : pose.translation()) x = std::nearbyint(x * 0x1p20) * 0x1p-20;
    const FoundPairs answer = ask(query_, pose);
    EXPECT_EQ(ask(fixed_moved, pose_of(pose.linear(), pose.translation() + away)).leaf_pairs,
              answer.leaf_pairs);
    const Eigen::Isometry3d straight = shift(pose.translation());
    EXPECT_EQ(ask(both_moved, straight).leaf_pairs, ask(query_, straight).leaf_pairs);
  }
}

TEST_P(EveryEngine, GivesAShortSpanTheFirstLeafPairs) {
  const Eigen::Isometry3d pose = some_pose(1);
  const FoundPairs all = ask(query_, pose);
  const std::size_t count = all.leaf_pairs.size();
  ASSERT_GT(count, 20u);
  EXPECT_FALSE(all.result.truncated);
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{7}, count - 1, count, count + 1, 2 * count}) {
    Guarded<LeafPair> out(size, 0);
    const QueryResult result = query_.leaf_pairs(pose, out.span());
    const std::size_t written = std::min(size, count);
    EXPECT_TRUE(std::equal(out.data(), out.data() + written, all.leaf_pairs.begin()));
    EXPECT_TRUE(out.intact());
    if (GetParam().published) {
      EXPECT_TRUE(out.untouched_from(written));
    }
    EXPECT_EQ(result.truncated, size < count);
    EXPECT_EQ(result.leaf_pairs, count);
    EXPECT_EQ(result.sphere_tests, all.result.sphere_tests);
    EXPECT_TRUE(result.complete);
  }
}

TEST_P(EveryEngine, TellsAPoseThatIsNoRigidMotion) {
  const FoundPairs before = ask(query_, some_pose(1));
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::Isometry3d& good : {Eigen::Isometry3d::Identity(), some_pose(1)}) {
    for (int i = 0; i < 16; ++i) {
      for (const double bad : {kNan, kInfinity, -kInfinity, i % 4 == 3 ? 0.5 : 2.0}) {
        if (i / 4 == 3 && bad == 2.0) continue;  // a translation
        poses.push_back(good);
        poses.back().matrix().data()[i] = bad;
      }
    }
    poses.push_back(good);
    poses.back().linear() *= -1;
  }
  const auto add = [&poses](const Eigen::Matrix3d& linear) {
    poses.push_back(pose_of(linear, {0, 0, 0}));
  };
  add(Eigen::Matrix3d::Zero());
  add(Eigen::Vector3d(1, 1, -1).asDiagonal());
  add(1.001 * Eigen::Matrix3d::Identity());
  add(1.0001 * Eigen::Matrix3d::Identity());
  add(Eigen::Matrix3d::Constant(1e200));
  for (const Eigen::Isometry3d& pose : poses) {
    Guarded<LeafPair> out(64, 0);
    const QueryResult result = query_.leaf_pairs(pose, out.span());
    EXPECT_EQ(result.status, QueryStatus::kInvalidPose) << pose.matrix();
    EXPECT_FALSE(result.complete);
    EXPECT_FALSE(result.truncated);
    EXPECT_EQ(result.leaf_pairs, 0u);
    EXPECT_EQ(result.sphere_tests, 0u);
    EXPECT_TRUE(out.untouched_from(0));
  }
  // And the next one is answered as if nothing had been.
  EXPECT_TRUE(same(ask(query_, some_pose(1)), before));
  EXPECT_GT(before.leaf_pairs.size(), 0u);
}

TEST_P(EveryEngine, ProjectsARotationThatIsNearlyOne) {
  const Eigen::Isometry3d pose = some_pose(2);
  Eigen::Isometry3d rough = pose;
  rough.linear() *= 1 + 3e-6;
  const FoundPairs answer = ask(query_, rough);
  EXPECT_EQ(answer.result.status, QueryStatus::kDone);
  EXPECT_EQ(answer.leaf_pairs, ask(query_, pose).leaf_pairs);
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
  stretch(0, 1) = stretch(1, 0) = 4e-4;
  rough.linear() = pose.linear() * stretch;
  const FoundPairs rougher = ask(query_, rough);
  EXPECT_EQ(rougher.result.status, QueryStatus::kDone);
  EXPECT_EQ(rougher.leaf_pairs, ask(query_, pose).leaf_pairs);
}

TEST_P(EveryEngine, MakesOneTestFarApart) {
  for (const double far :
       {10.0, 1e3, 1e9, 1e26, 1e200, 1e308, -1e308, std::numeric_limits<double>::max()}) {
    for (int axis = 0; axis < 4; ++axis) {
      const Eigen::Vector3d at = axis == 3 ? Eigen::Vector3d::Constant(far)
                                           : Eigen::Vector3d(far * Eigen::Vector3d::Unit(axis));
      const FoundPairs answer = ask(query_, shift(at));
      EXPECT_EQ(answer.result.status, QueryStatus::kDone);
      EXPECT_TRUE(answer.result.complete);
      EXPECT_EQ(answer.result.leaf_pairs, 0u) << "at " << at.transpose();
      EXPECT_EQ(answer.result.sphere_tests, 1u) << "at " << at.transpose();
      EXPECT_TRUE(std::isfinite(answer.result.pad)) << "at " << at.transpose();
      if (GetParam().published) continue;
      // Both bodies lie within 2.5 of their frames' origins.
      const double apart = at.stableNorm();
      ASSERT_TRUE(answer.result.distance) << "at " << at.transpose();
      EXPECT_GE(answer.result.distance->lower, std::min(0.99 * (apart - 5), 1e308));
      EXPECT_GE(answer.result.distance->upper, std::min(apart - 5, 1e308));
    }
  }
}

// The pad that docs/guarantees.md derives, from outside: of both bounding radii and the distance of
// the frames, 17 last bits for a test in float and 24 for one in double; twice that for a pair of
// leaves that is kept.
TEST_P(EveryEngine, StatesAPadNoLargerThanDerived) {
  for (const double far : {0.0, 1.0, 1000.0}) {
    for (std::uint64_t seed = 0; seed < samples(std::uint64_t{8}); ++seed) {
      Eigen::Isometry3d pose = some_pose(seed);
      pose.translation() *= 1 + far;
      const Eigen::Vector3d apart = pose * moving_.origin() - fixed_.origin();
      const double radii = fixed_.bounding_radius() + moving_.bounding_radius();
      const double bits = GetParam().published
                              ? 24 * (radii + std::sqrt(3.0) * apart.lpNorm<Eigen::Infinity>())
                              : 17 * (radii + apart.norm());
      const double pad = ask(query_, pose).result.pad;
      EXPECT_GT(pad, 0);
      EXPECT_LE(pad, 2 * 1.001 * bits * GetParam().last_bit())
          << "at " << pose.translation().transpose();
    }
  }
}

// Circumspheres of cubes that meet in a corner touch in a point; the surfaces there may touch too.
TEST_P(EveryEngine, FindsCubesThatTouchByACorner) {
  const SphereTree tree = tree_of(box({0, 0, 0}, {1, 1, 1}), 1);
  EngineQuery query(tree, tree, GetParam());
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d at((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                             (corner & 4) != 0 ? 1 : -1);
    EXPECT_EQ(ask(query, shift(at)).result.leaf_pairs, 1u);
    EXPECT_EQ(ask(query, shift(1.001 * at)).result.leaf_pairs, 0u);
  }
}

// A host may have set anything: the answer does not know it, and the host keeps it.
TEST_P(EveryEngine, KeepsTheFloatEnvironment) {
  constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40, kMasked = 0x1F80;
  const unsigned before = _mm_getcsr();
  const Scene& scene = solids()[0];
  Engine engine = GetParam();
  for (engine.workers = 1; engine.workers <= (engine.published ? 1 : 2); ++engine.workers) {
    EngineQuery query(scene.fixed, scene.moving, engine);
    FoundPairs answer = ask(query, scene.pose);
    const FoundPairs expected = answer;
    for (const unsigned rounding : {0u, 0x2000u, 0x4000u, 0x6000u}) {
      const unsigned strange = kMasked | kFlushToZero | kDenormalsAreZero | rounding;
      _mm_setcsr(strange);
      answer.result = query.leaf_pairs(scene.pose, answer.leaf_pairs);
      const unsigned after = _mm_getcsr();
      _mm_setcsr(before);
      EXPECT_EQ(after, strange);
      EXPECT_TRUE(same(answer, expected)) << std::hex << strange;
    }
  }
}

}  // namespace
}  // namespace ist::test
