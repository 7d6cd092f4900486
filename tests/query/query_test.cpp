#include "ist/query/query.h"

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "ist/base/error.h"
#include "ist/tree/sphere_tree.h"
#include "query/scenes.h"
#include "simd/targets.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Every target with every policy.
class QueryTest : public ::testing::TestWithParam<std::string> {
 protected:
  template <class Check>
  void for_each_policy(int workers, const Check& check) const {
    for (const SpherePolicy policy : kSpherePolicies) {
      SCOPED_TRACE(to_string(policy));
      Query query(scene_.fixed, scene_.moving, options_of(policy, GetParam(), workers));
      check(query);
    }
  }
  const Scene& scene_ = solids()[0];
};

INSTANTIATE_TEST_SUITE_P(Targets, QueryTest, ::testing::ValuesIn(all_targets()), name_of);

TEST_P(QueryTest, SaysWhatItWasMadeOf) {
  for_each_policy(1, [](const Query& query) {
    EXPECT_EQ(query.target(), GetParam());
    EXPECT_EQ(query.workers(), 1);
    EXPECT_EQ(query.sharing().chunks, 0u);
  });
  for_each_policy(2, [](const Query& query) { EXPECT_EQ(query.workers(), 2); });
}

TEST_P(QueryTest, APoseThatIsNoRigidMotionIsAStatus) {
  for_each_policy(1, [this](Query& query) {
    const FoundPairs before = ask(query, scene_.pose);
    for (Eigen::Index i = 0; i < 16; ++i) {
      for (const double bad : {kNan, kInfinity, -kInfinity, i % 4 == 3 ? 0.5 : 2.0}) {
        if (i / 4 == 3 && bad == 2.0) continue;  // a translation
        Eigen::Isometry3d pose = scene_.pose;
        pose.matrix().data()[i] = bad;
        const FoundPairs answer = ask(query, pose);
        EXPECT_EQ(answer.result.status, QueryStatus::kInvalidPose) << "entry " << i << ": " << bad;
        EXPECT_FALSE(answer.result.complete);
        EXPECT_FALSE(answer.result.truncated);
        EXPECT_EQ(answer.result.leaf_pairs, 0u);
        EXPECT_EQ(answer.result.sphere_tests, 0u);
      }
    }
    Eigen::Isometry3d mirrored = scene_.pose;
    mirrored.linear() *= -1;
    EXPECT_EQ(ask(query, mirrored).result.status, QueryStatus::kInvalidPose);
    EXPECT_TRUE(same(ask(query, scene_.pose), before));  // and is forgotten
  });
}

TEST_P(QueryTest, FarApartIsOneTest) {
  for_each_policy(1, [](Query& query) {
    for (const double far : {10.0, 1e9, 1e26, 1e300, -1e308, std::numeric_limits<double>::max()}) {
      for (const Eigen::Vector3d& at :
           {Eigen::Vector3d(far, 0, 0), Eigen::Vector3d(0, far, 0), Eigen::Vector3d(0, 0, far),
            Eigen::Vector3d(far, far, far)}) {
        const FoundPairs answer = ask(query, shift(at));
        EXPECT_EQ(answer.result.status, QueryStatus::kDone);
        EXPECT_TRUE(answer.result.complete);
        EXPECT_EQ(answer.result.leaf_pairs, 0u) << "at " << at.transpose();
        EXPECT_EQ(answer.result.sphere_tests, 1u) << "at " << at.transpose();
        EXPECT_TRUE(std::isfinite(answer.result.pad));
      }
    }
  });
}

// A scene that is a power of two times as large gives the same numbers.
TEST_P(QueryTest, DoesNotKnowTheUnit) {
  const auto answer_at = [this](double unit, SpherePolicy policy) {
    TriangleMesh ball = icosphere(2, 1), block = box({-0.9, -0.7, -0.8}, {0.9, 0.7, 0.8});
    for (Eigen::Vector3d& vertex : ball.vertices) vertex *= unit;
    for (Eigen::Vector3d& vertex : block.vertices) vertex *= unit;
    const SphereTree fixed = tree_of(ball, 12), moving = tree_of(block, 17);
    Query query(fixed, moving, options_of(policy, GetParam()));
    Eigen::Isometry3d pose = scene_.pose;
    pose.translation() *= unit;
    FoundPairs answer = ask(query, pose);
    answer.result.pad /= unit;
    return answer;
  };
  for (const SpherePolicy policy : kSpherePolicies) {
    const FoundPairs expected = answer_at(1, policy);
    EXPECT_GT(expected.result.leaf_pairs, 100u);
    for (const double unit : {0x1p-38, 0x1p-9, 0x1p20, 0x1p48}) {
      EXPECT_TRUE(same(answer_at(unit, policy), expected)) << to_string(policy) << ", " << unit;
    }
  }
}

// A host may have set anything: the answer does not know it, and the host keeps it.
TEST_P(QueryTest, KeepsTheFloatEnvironment) {
  constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40, kMasked = 0x1F80;
  const unsigned before = _mm_getcsr();
  for (const int workers : {1, 2}) {
    for_each_policy(workers, [&](Query& query) {
      FoundPairs answer = ask(query, scene_.pose);
      const FoundPairs expected = answer;
      for (const unsigned rounding : {0u, 0x2000u, 0x4000u, 0x6000u}) {
        const unsigned strange = kMasked | kFlushToZero | kDenormalsAreZero | rounding;
        _mm_setcsr(strange);
        answer.result = query.leaf_pairs(scene_.pose, answer.leaf_pairs);
        const unsigned after = _mm_getcsr();
        _mm_setcsr(before);
        EXPECT_EQ(after, strange);
        EXPECT_TRUE(same(answer, expected)) << std::hex << strange;
      }
    });
  }
}

TEST(Query, TakesTheTightestPolicyThatBothTreesHave) {
  const auto tree = [](SpherePolicy spheres) {
    BuildOptions options;
    options.voxel_size = 0.5;
    options.spheres = spheres;
    return build_tree(icosphere(1, 1), options);
  };
  const SphereTree table = tree(SpherePolicy::kTable), tight = tree(SpherePolicy::kTight),
                   slab = tree(SpherePolicy::kSlab);
  EXPECT_EQ(Query(slab, slab).policy(), SpherePolicy::kSlab);
  EXPECT_EQ(Query(slab, tight).policy(), SpherePolicy::kTight);
  EXPECT_EQ(Query(table, slab).policy(), SpherePolicy::kTable);
  EXPECT_EQ(error_name([&] { Query(slab, tight, options_of(SpherePolicy::kSlab)); }),
            to_string(ErrorCode::kPolicyMissing));
  EXPECT_EQ(error_name([&] { Query(slab, slab, options_of(SpherePolicy::kSlab, "abacus")); }),
            to_string(ErrorCode::kTargetMissing));
}

// Takes what it is given until it has enough.
struct Taken final : LeafPairStream {
  explicit Taken(std::size_t wanted) : enough(wanted) {}
  bool take(std::span<const LeafPair> some) noexcept override {
    EXPECT_LT(leaf_pairs.size(), enough);  // never asked again
    leaf_pairs.insert(leaf_pairs.end(), some.begin(), some.end());
    return leaf_pairs.size() < enough;
  }
  std::size_t enough;
  std::vector<LeafPair> leaf_pairs;
};

TEST_P(QueryTest, AStreamGetsAllContactsInOrderUntilItHasEnough) {
  for (const Scene& scene : {std::cref(scene_), std::cref(shells())}) {
    for (const int workers : {1, 2}) {
      for (const std::size_t pairs : {65536u, 100u}) {
        QueryOptions options = options_of(SpherePolicy::kSlab, GetParam(), workers);
        options.frontier_pairs = pairs;
        Query query(scene.fixed, scene.moving, options);
        const FoundPairs all = ask(query, scene.pose);
        Taken everything(all.leaf_pairs.size() + 1);
        const QueryResult result = query.leaf_pairs(scene.pose, everything);
        EXPECT_EQ(everything.leaf_pairs, all.leaf_pairs);
        EXPECT_EQ(result.leaf_pairs, all.leaf_pairs.size());
        EXPECT_EQ(result.sphere_tests, all.result.sphere_tests);
        EXPECT_FALSE(result.truncated);
        EXPECT_TRUE(result.complete);
        Taken some(10);
        const QueryResult part = query.leaf_pairs(scene.pose, some);
        EXPECT_FALSE(part.complete);
        EXPECT_EQ(part.leaf_pairs, some.leaf_pairs.size());
        ASSERT_GE(some.leaf_pairs.size(), 10u);
        // One frontier of leaves holds all of them, or a part.
        if (pairs == 100) {
          EXPECT_LT(some.leaf_pairs.size(), all.leaf_pairs.size());
        }
        EXPECT_TRUE(
            std::equal(some.leaf_pairs.begin(), some.leaf_pairs.end(), all.leaf_pairs.begin()));
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
