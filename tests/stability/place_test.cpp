#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ist/base/pose.h"
#include "query/triangles/triangle_tree.h"
#include "stability/all_engines.h"
#include "support/effort.h"
#include "support/exact_query.h"
#include "support/shapes.h"
#include "support/stability.h"

namespace ist::test {
namespace {

// The pose that does with two bodies at the origin what `pose` does where they are moved away; its
// translation is rounded once.
Eigen::Isometry3d at_the_origin(const Eigen::Isometry3d& pose, const Eigen::Vector3d& fixed_away,
                                const Eigen::Vector3d& moving_away) {
  Eigen::Isometry3d near = project_to_rigid(pose).value();
  for (Eigen::Index i = 0; i < 3; ++i) {
    mpq_class sum = mpq_class(near.translation()[i]) - mpq_class(fixed_away[i]);
    for (Eigen::Index j = 0; j < 3; ++j) {
      sum += mpq_class(near.linear()(i, j)) * mpq_class(moving_away[j]);
    }
    near.translation()[i] = sum.get_d();
  }
  return near;
}

// What coordinates of bodies some `scale` large are multiples of, so that they are held exactly
// both at the origin and 1e6 away.
double step_for(double scale) { return 0x1p-20 * std::exp2(std::floor(std::log2(scale))); }

// Every vertex times `scale`, to a multiple of `step`.
TriangleMesh rounded(TriangleMesh mesh, double scale, double step) {
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    for (double& x : vertex) x = std::floor(scale * x / step) * step;
  }
  return mesh;
}

// Two bodies with their triangles.
struct Bodies : RationalBodies {
  Bodies(const TriangleMesh& a, double size_a, const TriangleMesh& b, double size_b)
      : RationalBodies(a, tree_with_triangles(a, size_a), b, tree_with_triangles(b, size_b)) {}
  // The answer of all engines, held against the guarantee.
  FoundPairs check(AllEngines& engines, const Eigen::Isometry3d& pose, StabilityCase& wrong) const {
    const FoundPairs answer = engines(pose);
    const auto kept =
        keeps_guarantee(at(pose), engines.first().policy(), answer.leaf_pairs, answer.result.pad);
    wrong.sample(kept ? 0 : 1, 0, kept.message());
    return answer;
  }
};

class Place : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  const std::string policy_{to_string(GetParam())};
};

INSTANTIATE_TEST_SUITE_P(Policies, Place, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

// A kilometre away, where two doubles are 1e-10 mm apart: bodies of some mm, of some µm and of some
// metres. Coordinates are such that both places hold them exactly.
TEST_P(Place, OfTheSceneCostsNothing) {
  IST_SLOW();
  StabilityCase wrong("place", "1e6 mm away, bodies of 1e-3 to 1e3 mm, " + policy_,
                      "wrong answers");
  StabilityCase pads("place", "pads 1e6 mm away and at the origin, " + policy_,
                     "growth of the pad, in parts of it");
  const Eigen::Vector3d away(1e6, -1e6, 1e6);
  for (const double scale : {1e-3, 1.0, 1e3}) {
    SCOPED_TRACE(scale);
    const double step = step_for(scale);
    const TriangleMesh a = rounded(icosphere(1, 1), scale, step);
    const TriangleMesh b = rounded(box({-0.7, -0.5, -0.6}, {0.7, 0.5, 0.6}), scale, step);
    const Bodies near(a, 0.25 * scale, b, 0.25 * scale);
    const Bodies far(moved(a, away), 0.25 * scale, moved(b, away), 0.25 * scale);
    const Bodies fixed_far(moved(a, away), 0.25 * scale, b, 0.25 * scale);
    AllEngines at_origin(near.fixed, near.moving, GetParam());
    AllEngines both_away(far.fixed, far.moving, GetParam());
    AllEngines fixed_away(fixed_far.fixed, fixed_far.moving, GetParam());
    Random random(7);
    for (int i = 0; i < std::max(2, samples(4)); ++i) {
      const Eigen::Matrix3d rotation =
          i % 3 == 0 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : random.rotation();
      Eigen::Vector3d at = scale * random.uniform(1, 3) * random.direction();
      for (double& x : at) x = std::floor(x / step) * step;
      // In one pose the fixed body alone is away, in the other one both are.
      const Eigen::Isometry3d one = pose_of(rotation, at + away);
      const Eigen::Isometry3d both = pose_of(rotation, at + away - rotation * away);
      const auto compare = [&](const Bodies& bodies, AllEngines& engines,
                               const Eigen::Isometry3d& pose, const Eigen::Isometry3d& same_pose) {
        const FoundPairs there = bodies.check(engines, pose, wrong);
        const FoundPairs here = near.check(at_origin, same_pose, wrong);
        // Twice a float that is rounded up: of translations that differ in their last bits.
        pads.sample(std::abs(there.result.pad / here.result.pad - 1), 0x1p-22);
        if (i % 3 == 0) {
          EXPECT_EQ(there.leaf_pairs, here.leaf_pairs);
        }
      };
      compare(fixed_far, fixed_away, one, at_the_origin(one, away, {0, 0, 0}));
      compare(far, both_away, both, at_the_origin(both, away, away));
    }
  }
}

// The distance is certified there too, though a vertex is moved no better than to 1e-10 mm.
TEST(PlaceOfBodies, DoesNotMakeTheGapFalse) {
  StabilityCase gaps("place", "the gap of bodies of 1e-3 to 1e3 mm 1e6 mm away",
                     "mm from the middle of the interval to the distance");
  const Eigen::Vector3d away(1e6, -1e6, 1e6);
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const double step = step_for(scale);
    const TriangleMesh a = rounded(icosphere(1, 1), scale, step);
    const TriangleMesh b = rounded(box({-0.7, -0.5, -0.6}, {0.7, 0.5, 0.6}), scale, step);
    const SphereTree near_a = tree_with_triangles(a, 0.25 * scale);
    const SphereTree near_b = tree_with_triangles(b, 0.25 * scale);
    const SphereTree far_a = tree_with_triangles(moved(a, away), 0.25 * scale);
    const SphereTree far_b = tree_with_triangles(moved(b, away), 0.25 * scale);
    Query near(near_a, near_b), far(far_a, far_b);
    Random random(8);
    for (int i = 0; i < samples(60); ++i) {
      const Eigen::Matrix3d rotation = random.rotation();
      const Eigen::Vector3d at = scale * random.uniform(1.5, 2.5) * random.direction();
      const Eigen::Isometry3d pose = pose_of(rotation, at + away - rotation * away);
      const DistanceInterval here = near.distance(at_the_origin(pose, away, away), 0).distance;
      const DistanceInterval there = far.distance(pose, 0).distance;
      if (!(here.lower > 0)) continue;
      // At the origin the distance in the middle is right to some last bits, unless triangles are
      // as good as parallel.
      const double distance = 0.5 * (here.lower + here.upper);
      gaps.sample(std::abs(0.5 * (there.lower + there.upper) - distance),
                  0.5 * (there.upper - there.lower));
    }
  }
  EXPECT_GT(gaps.tried(), samples(50u));
}

// Planes on lattice planes, edges along voxels' edges, and turns of 90 and 180 degrees: as they
// are, and as a quaternion gives them, whose last bits are off.
TEST_P(Place, OnTheLatticeIsDecided) {
  StabilityCase wrong("place", "planes and edges on the lattice, quarter turns, " + policy_,
                      "wrong answers");
  TriangleMesh planes = box({0, 0, 0}, {4, 4, 4});
  planes = joined(planes, triangle({0, 0, 2}, {4, 0, 2}, {0, 4, 2}));  // in a lattice plane
  planes = joined(planes, triangle({1, 1, 0}, {1, 1, 4}, {3, 1, 2}));  // along voxels' edges
  planes = joined(planes, triangle({2, 2, 2}, {2, 2, 2}, {2, 2, 2}));  // a corner
  const TriangleMesh roof =
      joined(triangle({0, 0, 0}, {3, 0, 0}, {0, 3, 3}), triangle({3, 3, 3}, {3, 0, 0}, {0, 3, 3}));
  const Bodies bodies(planes, 1, roof, 1);
  AllEngines engines(bodies.fixed, bodies.moving, GetParam());
  std::size_t leaf_pairs = 0;
  int quaternions = 0;
  for (const Eigen::Matrix3d& turn : quarter_turns()) {
    const Eigen::Quaterniond q(turn), minus(-q.w(), -q.x(), -q.y(), -q.z());
    const Eigen::Matrix3d rotation = q.toRotationMatrix();
    EXPECT_EQ(rotation, minus.toRotationMatrix());
    for (const Eigen::Vector3d& at :
         {Eigen::Vector3d(4, 0, 0), Eigen::Vector3d(4, 4, 1), Eigen::Vector3d(1, 2, -3)}) {
      leaf_pairs += bodies.check(engines, pose_of(turn, at), wrong).leaf_pairs.size();
      if (rotation == turn) continue;
      ++quaternions;
      leaf_pairs += bodies.check(engines, pose_of(rotation, at), wrong).leaf_pairs.size();
    }
  }
  EXPECT_GT(leaf_pairs, 300u);
  EXPECT_GT(quaternions, 10);
}

TEST_P(Place, MayBeGivenInDenormals) {
  constexpr double kLeast = std::numeric_limits<double>::denorm_min(), kTiny = 1e-310;
  StabilityCase wrong("place", "denormal coordinates and translations, " + policy_,
                      "wrong answers");
  TriangleMesh spiky = box({kLeast, -kTiny, 0}, {1, 1, 1});
  spiky = joined(spiky, triangle({kTiny, kLeast, -kLeast}, {1, kTiny, 0.5}, {kLeast, 1, kTiny}));
  const TriangleMesh flat = joined(triangle({-kLeast, kTiny, 0}, {1, 0, kLeast}, {0, 1, -kTiny}),
                                   triangle({kTiny, kTiny, kTiny}, {0, 0, -kTiny}, {kLeast, 0, 0}));
  const Bodies bodies(spiky, 0.25, flat, 0.3);
  AllEngines engines(bodies.fixed, bodies.moving, GetParam());
  Random random(9);
  std::size_t leaf_pairs = 0;
  for (int i = 0; i < samples(12); ++i) {
    const Eigen::Matrix3d rotation =
        i % 2 == 0 ? quarter_turns()[random.below(24)] : random.rotation();
    const Eigen::Vector3d at(kTiny * random.uniform(-1, 1), i % 3 == 0 ? 1 : -kLeast,
                             i % 3 == 1 ? 0.5 : kTiny);
    leaf_pairs += bodies.check(engines, pose_of(rotation, at), wrong).leaf_pairs.size();
  }
  EXPECT_GT(leaf_pairs, least(100u, 0u));
}

// As far as doubles go, far beyond floats: one test of two roots, and an interval that holds the
// distance, or where no double does the largest one.
TEST_P(Place, BeyondTheRangeOfFloatEndsAtTheRoot) {
  constexpr double kMost = std::numeric_limits<double>::max();
  StabilityCase wrong("place", "translations up to the largest double, " + policy_,
                      "wrong answers");
  const SphereTree tree = tree_with_triangles(box({0, 0, 0}, {1, 1, 1}), 0.25);
  const auto at_root = [](const auto& result) { return result.sphere_tests == 1; };
  const auto within = [](const DistanceInterval& gap, const mpq_class& squared) {
    if (!std::isfinite(gap.lower) || !std::isfinite(gap.upper) || gap.lower <= 0) return false;
    const mpq_class lower(gap.lower), upper(gap.upper);
    return lower * lower <= squared && (upper * upper >= squared || gap.upper == kMost);
  };
  AllEngines engines(tree, tree, GetParam());
  Query& query = engines.first();
  ContactManifold points(tree, tree, GetParam(), {.margin = 2});
  for (const double far : {1e26, 1e39, 1e300, kMost}) {
    for (int axes = 1; axes < 8; ++axes) {
      for (const double sign : {-1.0, 1.0}) {
        Eigen::Vector3d at;
        for (int i = 0; i < 3; ++i) at[i] = (axes >> i & 1) != 0 ? sign * far : 0;
        const Eigen::Isometry3d pose = shift(at);
        const mpq_class apart = mpq_class(far) - 1;
        const mpq_class squared = (axes & 1) * apart * apart + (axes >> 1 & 1) * apart * apart +
                                  (axes >> 2) * apart * apart;
        const FoundPairs answer = engines(pose);
        const QueryResult within_budget = query.leaf_pairs(pose, std::span<LeafPair>(), Budget{});
        const DistanceResult gap = query.distance(pose, 0);
        const TrianglePairsResult exact = query.triangle_pairs(pose, {});
        const QueryResult felt = query.contacts(pose, points);
        const bool right =
            at_root(answer.result) && answer.leaf_pairs.empty() &&
            std::isfinite(answer.result.pad) && within(*answer.result.distance, squared) &&
            at_root(within_budget) && within(*within_budget.distance, squared) && at_root(gap) &&
            within(gap.distance, squared) && at_root(exact) && exact.triangle_pairs == 0 &&
            at_root(felt) && felt.leaf_pairs == 0 && points.points().empty() &&
            points.sums().weight == 0 && query.intersects(pose).answer == ist::Answer::kNo;
        wrong.sample(right ? 0 : 1, 0, "at " + std::to_string(at[0]));
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
