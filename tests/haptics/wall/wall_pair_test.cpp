#include "loop/haptics/wall/wall_pair.h"

#include <gtest/gtest.h>

#include <memory>

#include "query/query_cases.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;

struct WallBodies {
  WallBodies(const TriangleMesh& a, const TriangleMesh& b)
      : fixed(std::make_shared<WallBody>(build_tree(a))),
        held(std::make_shared<WallBody>(build_tree(b))),
        pair(fixed, held, {}),
        query(fixed->tree, held->tree) {}

  double distance(const Eigen::Isometry3d& pose) { return query.distance(pose, 0).distance.upper; }
  // A pose at about that distance.
  Eigen::Isometry3d near(Random& random, double wanted) {
    Eigen::Isometry3d pose = pose_of(random.rotation(), 6 * random.direction());
    const Vector way = -pose.translation().normalized();
    for (int k = 0; k < 40 && distance(pose) > 1.01 * wanted; ++k) {
      pose.translation() += (distance(pose) - wanted) * way;
    }
    return pose;
  }

  std::shared_ptr<const WallBody> fixed, held;
  WallPair pair;
  Query query;
};

// Moves a body whose points are within 3 of its origin: none goes farther than the way.
Eigen::Isometry3d shaken(Random& random, const Eigen::Isometry3d& pose, double way) {
  const double part = random.uniform(0, 1);
  Eigen::Isometry3d there = pose;
  there.linear() = Eigen::AngleAxisd(0.99 * part * way / 3, random.direction()) * pose.linear();
  there.translation() += 0.99 * (1 - part) * way * random.direction();
  return there;
}

TEST(WallPair, IsFreeOnlyWhereNothingIntersects) {
  Random random(1);
  int apart = 0, proven = 0, meeting = 0;
  const TriangleMesh ball = icosphere(2, 1), ring = torus(1.5, 0.5, 12, 9);
  WallBodies all[] = {{ball, ring}, {ring, ball}, {ring, box({-1, -1, -1}, {1, 1, 1})}};
  for (int i = 0; i < samples(60); ++i) {
    WallBodies& bodies = all[i % 3];
    const double margin = 0.02, way = random.uniform(0.1, 0.99) * margin;
    const Eigen::Isometry3d pose = bodies.near(random, random.uniform(0.01, 1.2) * margin);
    ASSERT_TRUE(bodies.pair.find(pose, margin, 0, {}).complete);
    EXPECT_EQ(bodies.pair.is_near(), bodies.distance(pose) <= margin);
    if (bodies.pair.is_near()) {
      const DistanceInterval distance = bodies.query.distance(pose, 0).distance;
      EXPECT_GE(bodies.pair.least_gap(), distance.lower);
      EXPECT_LE(bodies.pair.least_gap(), distance.upper);
    }
    for (int k = 0; k < 50; ++k) {
      const Eigen::Isometry3d there = shaken(random, pose, way);
      const bool is_free = bodies.pair.meets(there, way, {}) == Answer::kNo;
      if (bodies.query.intersects(there).answer == Answer::kYes) {
        EXPECT_FALSE(is_free);
        ++meeting;
      } else {
        ++apart;
        proven += is_free ? 1 : 0;
      }
    }
  }
  EXPECT_GT(meeting, samples(50));
  EXPECT_GT(proven, 0.99 * apart);
}

TEST(WallPair, ClearanceIsNeverAboveTheDistance) {
  Random random(2);
  WallBodies bodies(icosphere(2, 1), torus(1.5, 0.5, 12, 9));
  EXPECT_LE(bodies.pair.clearance(Eigen::Isometry3d::Identity()), 0);
  int known = 0;
  for (int i = 0; i < samples(200); ++i) {
    const Eigen::Isometry3d pose = bodies.near(random, random.uniform(0.001, 2));
    ASSERT_TRUE(bodies.pair.find(pose, 0.01, random.uniform(0, 3), {}).complete);
    for (int k = 0; k < 10; ++k) {
      const Eigen::Isometry3d there = shaken(random, pose, random.uniform(0, 3));
      const double clear = bodies.pair.clearance(there);
      EXPECT_LE(clear, bodies.query.distance(there, 0).distance.upper);
      known += clear > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(known, samples(100));
  bodies.pair.forget();
  EXPECT_LE(bodies.pair.clearance(Eigen::Isometry3d::Identity()), 0);
}

TEST(WallPair, FindAtTheSamePoseTwiceCostsNothing) {
  Random random(3);
  WallBodies bodies(icosphere(2, 1), icosphere(2, 1));
  for (const double apart : {0.005, 0.3, 2.0}) {
    for (const double wanted : {0.0, 0.1, 10.0}) {
      SCOPED_TRACE(wanted);
      const Eigen::Isometry3d pose = bodies.near(random, apart);
      bodies.pair.forget();
      const WallPair::Search first = bodies.pair.find(pose, 0.01, wanted, {});
      EXPECT_TRUE(first.complete);
      EXPECT_GT(first.tests, 0u);
      const double gap = bodies.pair.least_gap();
      const WallPair::Search again = bodies.pair.find(pose, 0.01, wanted, {});
      EXPECT_TRUE(again.complete);
      EXPECT_EQ(again.tests, 0u);
      EXPECT_EQ(bodies.pair.least_gap(), gap);
    }
  }
}

TEST(WallPair, WithoutABudgetIsIncomplete) {
  Random random(4);
  WallBodies bodies(icosphere(2, 1), icosphere(2, 1));
  Budget none;
  none.tests = 0;
  for (int i = 0; i < samples(20); ++i) {
    ASSERT_TRUE(bodies.pair.find(shift({9, 0, 0}), 0.01, 1, {}).complete);  // the clearance is long
    const Eigen::Isometry3d pose = bodies.near(random, 0.005);
    EXPECT_FALSE(bodies.pair.find(pose, 0.01, 1, none).complete);
    EXPECT_FALSE(bodies.pair.is_near());
    EXPECT_EQ(bodies.pair.meets(pose, 0.001, {}), Answer::kUnknown);
    EXPECT_TRUE(bodies.pair.find(pose, 0.01, 1, {}).complete);
    EXPECT_TRUE(bodies.pair.is_near());
  }
  Eigen::Isometry3d bent = Eigen::Isometry3d::Identity();
  bent.linear() *= 2;
  EXPECT_FALSE(bodies.pair.find(bent, 0.01, 1, {}).complete);
}

}  // namespace
}  // namespace ist::test
