#include <gtest/gtest.h>

#include <cmath>

#include "ist/base/pose.h"
#include "ist/measure/penetration.h"
#include "ist/measure/signed_distance.h"
#include "measure/body_pair.h"
#include "query/query_cases.h"
#include "simd/targets.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/shapes.h"

// penetration() of bodies with outer balls against bodies without them, cold and carried.
namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Pose = Eigen::Isometry3d;
using DepthStatus = Penetration::Status;

struct Twice {
  Twice(const TriangleMesh& a, const TriangleMesh& b) : plain(a, b, 0), prepared(a, b, 0) {
    prepare_depth(prepared.fixed);
    prepare_depth(prepared.moving);
  }
  BodyPair plain, prepared;
};

Pose random_pose(Random& random, double farthest) {
  Pose pose = Pose::Identity();
  pose.linear() = random.rotation();
  pose.translation() = random.uniform(0, farthest) * random.direction();
  return pose;
}

// The interval overlaps the true one, is as narrow as promised, and its point is as deep as it
// says.
void expect_true(Twice& bodies, const Pose& pose, const Penetration& found, double tolerance) {
  const Penetration truth = penetration(bodies.plain.query, pose, 0.1 * tolerance);
  ASSERT_EQ(found.status, DepthStatus::kDone);
  ASSERT_TRUE(found.complete);
  ASSERT_LE(found.lower, found.upper);
  ASSERT_LE(found.lower, truth.upper);
  ASSERT_GE(found.upper, truth.lower);
  ASSERT_LE(found.upper - found.lower, std::max(tolerance, found.narrowest) * (1 + 1e-12));
  if (found.lower <= 0) return;
  const Vector at = found.of_moving ? found.point : Vector(pose.inverse() * found.point);
  const SphereTree& body = found.of_moving ? bodies.plain.fixed : bodies.plain.moving;
  const SurfaceDistance inside = signed_distance(body, std::vector<Vector>{at}, HUGE_VAL)[0];
  ASSERT_NEAR(inside.distance, -found.lower, found.narrowest * 4 + 1e-12);
}

std::vector<TriangleMesh> shapes() {
  return {icosphere(3, 2),
          torus(3, 1, 36, 18),
          box({-2, -1, -1}, {2, 1, 1}),
          plate_with_holes(2),
          tube(1, 2, 1.5, 0.7),
          joined(icosphere(2, 2), moved(icosphere(2, 2), {1, 0.5, 0})),
          inside_out(cylinder(12, 1, 6))};
}

TEST(DepthByBalls, OverlapsTheDepthWithoutThem) {
  Random random(17);
  for (const TriangleMesh& a : shapes()) {
    for (const TriangleMesh& b : shapes()) {
      Twice bodies(a, b);
      for (int i = 0; i < samples(6); ++i) {
        const Pose pose = random_pose(random, 4);
        for (const double tolerance : {1e-2, 1e-3}) {
          expect_true(bodies, pose, penetration(bodies.prepared.query, pose, tolerance), tolerance);
        }
      }
    }
  }
}

TEST(DepthByBalls, IsNoneWhereBodiesAreApart) {
  Twice bodies(torus(8, 2, 40, 20), icosphere(3, 1));
  for (const Vector& at : {Vector(0, 0, 0), Vector(0, 0, 30), Vector(11.2, 0, 0),
                           Vector(1e12, 0, 0), Vector(1e155, 1e155, 0)}) {
    const Penetration found = penetration(bodies.prepared.query, place(at), 1e-3);
    EXPECT_EQ(found.lower, 0) << at.transpose();
    EXPECT_EQ(found.upper, 0) << at.transpose();
    EXPECT_TRUE(found.complete);
    DepthTracker tracker;
    const Penetration tracked =
        penetration(bodies.prepared.query, place(at), 1e-3, {.tracker = &tracker});
    EXPECT_EQ(tracked.lower, 0) << at.transpose();
    EXPECT_LE(tracked.upper, 1e-3) << at.transpose();
  }
}

TEST(DepthByBalls, IsTrueAtEveryExtent) {
  for (const double scale : {1e-12, 1e-6, 1.0, 1e7, 1e15}) {
    const auto cube = [&](double edge) {
      return box(Vector::Constant(-0.5 * edge), Vector::Constant(0.5 * edge));
    };
    Twice bodies(cube(scale), cube(scale));
    DepthTracker tracker;
    for (const Vector& way : {Vector(0.75, 0.1, 0.2), Vector(0.7500001, 0.1, 0.2),
                              Vector(0.6, 0.7, 0.75), Vector(0, 0, 0.75)}) {
      const Pose pose = place(scale * way);
      for (DepthTracker* one : {static_cast<DepthTracker*>(nullptr), &tracker}) {
        const Penetration found =
            penetration(bodies.prepared.query, pose, 1e-5 * scale, {.tracker = one});
        EXPECT_TRUE(found.complete);
        EXPECT_NEAR(found.lower / scale, 0.25, 1.1e-5) << scale << ' ' << way.transpose();
        EXPECT_GE(found.upper / scale, 0.25 - 1e-6);
        EXPECT_LE((found.upper - found.lower) / scale, 1e-5 * (1 + 1e-9));
      }
    }
  }
}

TEST(DepthByBalls, OfBodiesOfVeryDifferentSizesIsTrue) {
  for (const double ratio : {1e-6, 1e-3, 1e3}) {
    Twice bodies(icosphere(2, 1), icosphere(2, ratio));
    const Pose pose = place({std::max(1.0, ratio) - 0.5 * std::min(1.0, ratio), 0.01, 0.02});
    const double tolerance = 1e-3 * std::min(1.0, ratio);
    expect_true(bodies, pose, penetration(bodies.prepared.query, pose, tolerance), tolerance);
  }
}

TEST(DepthByBalls, ReachesATolerancesBelowTheRoundingOfFloats) {
  Twice bodies(icosphere(3, 2), torus(3, 1, 36, 18));
  const Pose pose = place({2, 0.3, 0.5});
  for (const double tolerance : {1e-6, 1e-9, 0.0}) {
    const Penetration found = penetration(bodies.prepared.query, pose, tolerance);
    EXPECT_TRUE(found.complete);
    EXPECT_LE(found.upper - found.lower, std::max(tolerance, found.narrowest) * (1 + 1e-9));
    const Penetration truth = penetration(bodies.plain.query, pose, tolerance);
    EXPECT_LE(found.lower, truth.upper);
    EXPECT_GE(found.upper, truth.lower);
  }
}

TEST(DepthByBalls, HasTheSameBitsOnEveryTarget) {
  Twice bodies(torus(3, 1, 36, 18), icosphere(3, 2));
  const Pose pose = place({1.9, 0.4, 0.7});
  const Penetration truth = penetration(bodies.prepared.query, pose, 1e-3);
  for (const std::string& target : all_targets()) {
    Query query(bodies.prepared.fixed, bodies.prepared.moving, {.target = target});
    const Penetration found = penetration(query, pose, 1e-3);
    EXPECT_EQ(found.lower, truth.lower) << target;
    EXPECT_EQ(found.upper, truth.upper) << target;
    EXPECT_EQ(found.point, truth.point) << target;
    EXPECT_EQ(found.points, truth.points) << target;
  }
}

TEST(DepthByBalls, IsTrueAndWiderWhereABudgetEndsIt) {
  Twice bodies(icosphere(4, 4), torus(3, 1, 36, 18));
  const Pose pose = place({2, 0, 0.5});
  const Penetration truth = penetration(bodies.plain.query, pose, 1e-4);
  bool was_cut = false;
  for (const std::uint64_t points : {0U, 1U, 10U, 30U, 100U, 1000U}) {
    const Penetration some =
        penetration(bodies.prepared.query, pose, 1e-4, {.budget = {.tests = points}});
    EXPECT_LE(some.lower, truth.upper) << points;
    EXPECT_GE(some.upper, truth.lower) << points;
    EXPECT_EQ(some.complete, some.upper - some.lower <= 1e-4) << points;
    was_cut = was_cut || !some.complete;
  }
  EXPECT_TRUE(was_cut);
  int asked = 0;
  const Penetration stopped =
      penetration(bodies.prepared.query, pose, 0, {.proceed = [&](double) { return ++asked < 1; }});
  EXPECT_GE(stopped.upper, truth.lower);
}

// Sliding, lifting, turning; small steps and jumps.
TEST(DepthTracker, HoldsTheTruthAlongMotions) {
  Random random(19);
  for (const double step : {1e-4, 1e-2, 0.3}) {
    Twice bodies(torus(3, 1, 36, 18), icosphere(3, 2));
    DepthTracker tracker;
    Pose pose = place({1.9, 0.4, 0.7});
    for (int k = 0; k < samples(60); ++k) {
      pose = *project_to_rigid(Pose(Eigen::Translation3d(step * random.direction()) *
                                    Eigen::AngleAxisd(0.3 * step, random.direction()) * pose));
      const Penetration found =
          penetration(bodies.prepared.query, pose, 1e-3, {.tracker = &tracker});
      expect_true(bodies, pose, found, 1e-3);
    }
  }
}

TEST(DepthTracker, OfAStillBodyLooksAtFewPoints) {
  Twice bodies(torus(3, 1, 36, 18), icosphere(3, 2));
  DepthTracker tracker;
  const PenetrationOptions options{.tracker = &tracker};
  const Pose pose = place({1.9, 0.4, 0.7});
  const Penetration first = penetration(bodies.prepared.query, pose, 1e-3, options);
  const Penetration second = penetration(bodies.prepared.query, pose, 1e-3, options);
  EXPECT_GT(first.points, 10U);
  EXPECT_LE(second.points, 4U);
  EXPECT_LE(second.lower, first.upper);
  EXPECT_GE(second.upper, first.lower);
  tracker.forget();
  const Penetration again = penetration(bodies.prepared.query, pose, 1e-3, options);
  EXPECT_EQ(again.points, first.points);
  EXPECT_EQ(again.lower, first.lower);
}

// Budgets cut questions, the tolerance changes, a pose is no motion, and other bodies come between.
TEST(DepthTracker, StaysTrueWhateverCameBefore) {
  Random random(23);
  Twice bodies(torus(3, 1, 36, 18), icosphere(3, 2)), others(icosphere(2, 1), icosphere(2, 1));
  DepthTracker tracker;
  for (int k = 0; k < samples(100); ++k) {
    const Pose pose = place(Vector(1.9, 0.4, 0.7) + 0.05 * random.direction());
    const double tolerance = k % 3 == 0 ? 1e-2 : 1e-3;
    PenetrationOptions options{.tracker = &tracker};
    options.budget.tests = random.below(12);
    const Penetration cut = penetration(bodies.prepared.query, pose, tolerance, options);
    const Penetration truth = penetration(bodies.plain.query, pose, 1e-4);
    ASSERT_LE(cut.lower, truth.upper);
    ASSERT_GE(cut.upper, truth.lower);
    if (k % 7 == 0) {
      static_cast<void>(
          penetration(others.prepared.query, place({0.5, 0, 0}), 1e-2, {.tracker = &tracker}));
    }
    if (k % 11 == 0) {
      Pose sheared = pose;
      sheared(0, 1) += 0.1;
      EXPECT_EQ(penetration(bodies.prepared.query, sheared, 1e-2, {.tracker = &tracker}).status,
                DepthStatus::kInvalidPose);
    }
    const Penetration whole =
        penetration(bodies.prepared.query, pose, tolerance, {.tracker = &tracker});
    expect_true(bodies, pose, whole, tolerance);
  }
}

TEST(DepthTracker, OfBodiesWithoutBallsIsAsWithoutATracker) {
  BodyPair bodies(torus(3, 1, 18, 9), icosphere(3, 2), 0);
  DepthTracker tracker;
  for (const double x : {1.9, 1.8, 9.0}) {
    const Pose pose = place({x, 0.4, 0.7});
    const Penetration plain = penetration(bodies.query, pose, 1e-3),
                      tracked = penetration(bodies.query, pose, 1e-3, {.tracker = &tracker});
    EXPECT_EQ(plain.lower, tracked.lower);
    EXPECT_EQ(plain.upper, tracked.upper);
    EXPECT_EQ(plain.points, tracked.points);
  }
  prepare_depth(bodies.fixed);
  prepare_depth(bodies.moving);
  const Pose pose = place({1.9, 0.4, 0.7});
  const Penetration balls = penetration(bodies.query, pose, 1e-3, {.tracker = &tracker});
  EXPECT_LE(balls.upper - balls.lower, 1e-3 * (1 + 1e-12));
}

TEST(DepthByBalls, OfOpenBodiesIsNoQuestion) {
  Twice bodies(open_strip(3), box({0, 0, 0}, {1, 1, 1}));
  EXPECT_EQ(penetration(bodies.prepared.query, Pose::Identity(), 0.1).status,
            DepthStatus::kFixedNotClosed);
}

TEST(DepthByBalls, OfTheRealJawsHoldsTheTruthWithAFewPoints) {
  IST_SLOW();
  const std::filesystem::path folder = data_dir();
  if (!std::filesystem::exists(folder)) IST_SKIP("no real meshes at " << folder);
  Twice jaws(read_mesh(folder / "human_maxilla.stl"), read_mesh(folder / "human_mandible.stl"));
  Random random(29);
  DepthTracker tracker;
  for (int k = 0; k < samples(60); ++k) {
    Pose pose = place({0, 0, -2.2 + 0.06 * k});
    if (k % 3 != 0) {
      const Vector about(0, -10, 50);
      pose = *project_to_rigid(
          Pose(Eigen::Translation3d(about + random.uniform(0, 1.5) * random.direction()) *
               Eigen::AngleAxisd(random.uniform(-0.04, 0.04), random.direction()) *
               Eigen::Translation3d(-about)));
    }
    const Penetration cold = penetration(jaws.prepared.query, pose, 0.01);
    expect_true(jaws, pose, cold, 0.01);
    EXPECT_LT(cold.points, 2000U);
    expect_true(jaws, pose, penetration(jaws.prepared.query, pose, 0.01, {.tracker = &tracker}),
                0.01);
  }
}

}  // namespace
}  // namespace ist::test
