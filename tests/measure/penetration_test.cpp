#include "ist/measure/penetration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ist/measure/signed_distance.h"
#include "ist/models/models.h"
#include "measure/body_pair.h"
#include "query/query_cases.h"
#include "simd/targets.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Pose = Eigen::Isometry3d;
using DepthStatus = Penetration::Status;

struct Bodies : BodyPair {
  using BodyPair::BodyPair;
  [[nodiscard]] Penetration at(const Pose& pose, double tolerance,
                               const PenetrationOptions& options = {}) {
    return penetration(query, pose, tolerance, options);
  }
};

// A point and its direction say what the interval does.
void expect_consistent(const Bodies& bodies, const Pose& pose, const Penetration& found,
                       double tolerance) {
  EXPECT_EQ(found.status, DepthStatus::kDone);
  EXPECT_TRUE(found.complete);
  EXPECT_LE(found.lower, found.upper);
  EXPECT_LE(found.upper - found.lower, std::max(tolerance, found.narrowest) * (1 + 1e-12));
  if (found.lower <= 0) return;
  const Vector at = found.of_moving ? found.point : Vector(pose.inverse() * found.point);
  const SphereTree& body = found.of_moving ? bodies.fixed : bodies.moving;
  const SphereTree& surface = found.of_moving ? bodies.moving : bodies.fixed;
  const SurfaceDistance inside = signed_distance(body, std::vector<Vector>{at}, HUGE_VAL)[0];
  EXPECT_NEAR(inside.distance, -found.lower, found.narrowest + 1e-12);
  const Vector on = found.of_moving ? Vector(pose.inverse() * found.point) : found.point;
  EXPECT_NEAR(signed_distance(surface, std::vector<Vector>{on}, HUGE_VAL)[0].distance, 0, 1e-12);
  const Vector out =
      found.of_moving ? Vector(inside.closest - at) : Vector(pose.linear() * (inside.closest - at));
  EXPECT_NEAR(found.direction.dot(out), found.lower, 1e-9);
  EXPECT_NEAR(found.direction.norm(), 1, 1e-12);
}

TEST(Penetration, OfSpheresIsTheirClosedForm) {
  Bodies bodies(icosphere(5, 4), icosphere(5, 2));
  constexpr double kFacets = 0.006;
  for (const double apart : {5.9, 5.5, 4.0, 2.5, 2.0}) {
    const Pose pose = place(apart * Vector(0.6, 0, 0.8));
    const Penetration found = bodies.at(pose, 1e-3);
    expect_consistent(bodies, pose, found, 1e-3);
    EXPECT_NEAR(found.lower, 6 - apart, kFacets) << apart;
  }
  // One wholly inside the other, whose surfaces do not meet.
  const Penetration inside = bodies.at(place({0, 1.5, 0}), 1e-3);
  EXPECT_NEAR(inside.lower, 3.5, kFacets) << "its nearest point to the middle is 0.5 from there";
  expect_consistent(bodies, place({0, 1.5, 0}), inside, 1e-3);
}

TEST(Penetration, IsTheSameWithoutVoxels) {
  const TriangleMesh a = icosphere(3, 4), b = box({-1, -1, -1}, {1, 1, 1});
  BodyPair voxels(a, b), alone(a, b, 0);
  for (const double apart : {7.0, 4.5, 4.0, 1.0}) {
    const Pose pose = place(apart * Vector(0.6, 0, 0.8));
    const Penetration found = penetration(alone.query, pose, 1e-3),
                      wanted = penetration(voxels.query, pose, 1e-3);
    EXPECT_LE(found.lower, wanted.upper) << apart;
    EXPECT_GE(found.upper, wanted.lower) << apart;
    EXPECT_LE(found.upper - found.lower, 1e-3 + found.narrowest) << apart;
  }
}

TEST(Penetration, SaysHowFarThePoseWas) {
  Bodies bodies(icosphere(2, 4), icosphere(2, 2));
  Pose rough = place({5, 0, 0});
  for (const double skew : {0.0, 5e-4, 0.2}) {
    rough(0, 1) = skew;
    EXPECT_NEAR(bodies.at(rough, 1).rotation_error, skew, 1e-15);
  }
}

TEST(Penetration, OfBoxesIsExact) {
  Bodies bodies(box({0, 0, 0}, {4, 4, 4}), box({0, 0, 0}, {1, 1, 1}));
  const Penetration face = bodies.at(place({1.5, 1.5, 3.5}), 1e-6);
  expect_consistent(bodies, place({1.5, 1.5, 3.5}), face, 1e-6);
  EXPECT_LE(face.lower, 0.5);
  EXPECT_GE(face.upper, 0.5);
  EXPECT_TRUE(face.of_moving);
  EXPECT_NEAR(face.direction[2], 1, 1e-6);
  // A corner in a corner: the least way out is along one axis.
  const Penetration corner = bodies.at(place({3.75, 3.5, 3.25}), 1e-6);
  EXPECT_NEAR(corner.lower, 0.25, 1e-6);
  // The small one in the middle: each of its faces is 1.5 deep.
  const Penetration middle = bodies.at(place({1.5, 1.5, 1.5}), 1e-4);
  EXPECT_NEAR(middle.lower, 1.5, 1e-4);
}

TEST(Penetration, OfATorusInATorusIsItsClosedForm) {
  Bodies bodies(torus(8, 3, 160, 80), torus(8, 1, 160, 40));
  const Pose pose = place({0, 0, 1.5});
  const Penetration found = bodies.at(pose, 0.005);
  expect_consistent(bodies, pose, found, 0.005);
  EXPECT_NEAR(found.lower, 2.5, 0.015) << "3 less the nearest point to the ring, 1.5 - 1";
}

TEST(Penetration, IsNoneWhereBodiesAreApart) {
  Bodies bodies(torus(8, 2, 40, 20), icosphere(3, 1));
  for (const Vector& at : {Vector(0, 0, 0), Vector(0, 0, 30), Vector(11.2, 0, 0)}) {
    const Penetration found = bodies.at(place(at), 1e-3);
    EXPECT_EQ(found.lower, 0) << at.transpose();
    EXPECT_EQ(found.upper, 0) << at.transpose();
    EXPECT_TRUE(found.complete);
  }
}

// The largest depth of many points of both surfaces, and how far the next one may be.
double deepest_sample(const Bodies& bodies, const Pose& pose, double spacing) {
  double deepest = 0;
  const auto look = [&](const SphereTree& surface, const SphereTree& body, const Pose& to_body) {
    std::vector<Vector> points;
    const TriangleMesh& mesh = *surface.triangles();
    for (const Triangle& t : mesh.triangles) {
      const Vector a = to_body * mesh.vertices[t[0]], b = to_body * mesh.vertices[t[1]];
      const Vector c = to_body * mesh.vertices[t[2]];
      const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
      const int n = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
      for (int i = 0; i <= n; ++i) {
        for (int j = 0; i + j <= n; ++j) {
          points.push_back(a + double(i) / n * (b - a) + double(j) / n * (c - a));
        }
      }
    }
    for (const SurfaceDistance& one : signed_distance(body, points, HUGE_VAL)) {
      deepest = std::max(deepest, -one.distance);
    }
  };
  look(bodies.moving, bodies.fixed, pose);
  look(bodies.fixed, bodies.moving, pose.inverse());
  return deepest;
}

TEST(Penetration, HoldsTheDeepestOfManySamples) {
  IST_SLOW();
  Random random(61);
  constexpr double kSpacing = 0.05, kTolerance = 0.01;
  const TriangleMesh shapes[] = {icosphere(2, 2), torus(3, 1, 18, 9), box({-2, -1, -1}, {2, 1, 1}),
                                 plate_with_holes(2), tube(1, 2, 1.5, 0.7)};
  for (const TriangleMesh& a : shapes) {
    for (const TriangleMesh& b : shapes) {
      Bodies bodies(a, b);
      for (int i = 0; i < samples(3); ++i) {
        Pose pose = Pose::Identity();
        pose.linear() = random.rotation();
        pose.translation() = random.uniform(0, 3) * random.direction();
        const Penetration found = bodies.at(pose, kTolerance);
        expect_consistent(bodies, pose, found, kTolerance);
        const double sample = deepest_sample(bodies, pose, kSpacing);
        EXPECT_GE(found.upper, sample - 1e-9);
        EXPECT_LE(found.lower, sample + kSpacing);
      }
    }
  }
}

TEST(Penetration, OfJawsHoldsTheDeepestOfTheirVerticesAndIsWarmAsTrueAsCold) {
  Bodies jaws(make_jaw(Jaw::kUpper, 1), make_jaw(Jaw::kLower, 1), 1);
  Penetration last;
  for (const double dz : {0.0, -0.02, -0.3, -0.9, -3.0, 0.2}) {
    const Pose pose = place({0, 0, dz});
    const Penetration cold = jaws.at(pose, 0.01), warm = jaws.at(pose, 0.01, {.last = &last});
    expect_consistent(jaws, pose, cold, 0.01);
    expect_consistent(jaws, pose, warm, 0.01);
    EXPECT_LE(std::max(cold.lower, warm.lower), std::min(cold.upper, warm.upper)) << dz;
    double vertices = 0;
    for (const auto& one : distance_map(jaws.moving, jaws.fixed, pose, 5)) {
      if (one.distance < -vertices) vertices = -one.distance;
    }
    EXPECT_GE(cold.upper, vertices);
    last = warm;
  }
}

TEST(Penetration, HasTheSameBitsOnEveryTarget) {
  const TriangleMesh a = torus(3, 1, 18, 9), b = icosphere(3, 2);
  const SphereTree fixed = build_tree(a, {.voxel_size = 0.5}),
                   moving = build_tree(b, {.voxel_size = 0.5});
  Query best(fixed, moving);
  const Pose pose = place({1.9, 0.4, 0.7});
  const Penetration truth = penetration(best, pose, 1e-3);
  for (const std::string& target : all_targets()) {
    Query query(fixed, moving, {.target = target});
    const Penetration found = penetration(query, pose, 1e-3);
    EXPECT_EQ(found.lower, truth.lower) << target;
    EXPECT_EQ(found.upper, truth.upper) << target;
    EXPECT_EQ(found.point, truth.point) << target;
    EXPECT_EQ(found.points, truth.points) << target;
  }
}

TEST(Penetration, IsTrueAndWiderWhereABudgetEndsIt) {
  Bodies bodies(icosphere(4, 4), torus(3, 1, 36, 18));
  const Pose pose = place({2, 0, 0.5});
  const Penetration truth = bodies.at(pose, 1e-4);
  double width = HUGE_VAL;
  for (const std::uint64_t points : {0U, 10U, 100U, 1000U, 100000U}) {
    const Penetration some = bodies.at(pose, 1e-4, {.budget = {.tests = points}});
    EXPECT_LE(some.lower, truth.upper);
    EXPECT_GE(some.upper, truth.lower);
    EXPECT_EQ(some.complete, some.upper - some.lower <= 1e-4) << points;
    EXPECT_LE(some.upper - some.lower, width);
    width = some.upper - some.lower;
  }
  EXPECT_FALSE(bodies.at(pose, 1e-4, {.budget = {.tests = 10}}).complete);
  EXPECT_FALSE(
      bodies.at(pose, 1e-4, {.budget = {.deadline = Budget::Clock::time_point::min()}}).complete);
}

TEST(Penetration, IsNoneHoweverFarBodiesAre) {
  Bodies bodies(icosphere(2, 1), icosphere(2, 1));
  for (const double far : {1e5, 1e12, 1e16, 1e155}) {
    const Penetration found = bodies.at(place({far, 0.3 * far, 0}), 1e-3);
    EXPECT_EQ(found.upper, 0) << far;
    EXPECT_TRUE(found.complete);
  }
}

// The real pair as stored. Its deepest vertices are known from VTK's implicit distance: 1.0214 mm
// of the mandible, 1.0523 of the maxilla.
TEST(Penetration, OfTheRealJawsHoldsTheDepthOfTheirVertices) {
  IST_SLOW();
  const std::filesystem::path folder = data_dir();
  if (!std::filesystem::exists(folder)) IST_SKIP("no real meshes at " << folder);
  Bodies jaws(read_mesh(folder / "human_maxilla.stl"), read_mesh(folder / "human_mandible.stl"), 2);
  const Penetration found = jaws.at(Pose::Identity(), 0.01);
  expect_consistent(jaws, Pose::Identity(), found, 0.01);
  EXPECT_GE(found.upper, 1.0523);
  EXPECT_LE(found.upper, 1.1);
  const auto deepest = [](const std::vector<SurfaceDistance>& map) {
    double least = 0;
    for (const SurfaceDistance& one : map) least = one.distance < least ? one.distance : least;
    return -least;
  };
  EXPECT_NEAR(deepest(distance_map(jaws.moving, jaws.fixed, Pose::Identity(), 2)), 1.02136, 1e-5);
  EXPECT_NEAR(deepest(distance_map(jaws.fixed, jaws.moving, Pose::Identity(), 2)), 1.05233, 1e-5);
}

// Turned by an angle that no face is along an axis of the mesh.
Eigen::Matrix3d askew() {
  return (Eigen::AngleAxisd(0.7, Vector(1, 2, 3).normalized())).toRotationMatrix();
}

TEST(Penetration, OfACubeInALongBarIsExact) {
  for (const double length : {10.0, 1e3, 1e6}) {
    const TriangleMesh bar = box({-0.5 * length, -0.5, -0.5}, {0.5 * length, 0.5, 0.5});
    const TriangleMesh cube = box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    for (const Eigen::Matrix3d& turn : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), askew()}) {
      Bodies bodies(turned(bar, turn), turned(cube, turn), std::max(0.5, 1e-4 * length));
      const Penetration found = bodies.at(place(turn * Vector(1, 0.2, 0.75)), 1e-3);
      EXPECT_TRUE(found.complete) << length;
      EXPECT_FALSE(found.capped);
      EXPECT_LE(found.lower, 0.25) << length;
      EXPECT_GE(found.upper, 0.25) << length;
      EXPECT_LE(found.upper - found.lower, std::max(1e-3, found.narrowest) * (1 + 1e-9));
      EXPECT_LT(found.points, 100'000U) << length;
    }
  }
}

// Of a prism with many sides each side is a needle.
TEST(Penetration, OfABallInAPrismOfNeedlesIsItsClosedForm) {
  for (const int quarter : {100, least(1000, 300)}) {
    for (const Eigen::Matrix3d& turn : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), askew()}) {
      Bodies bodies(turned(cylinder(quarter, 1, 100), turn), icosphere(4, 1));
      for (const double off : {0.0, 1.0}) {
        const Penetration found = bodies.at(place(turn * Vector(off, 0, 50)), 1e-3);
        EXPECT_TRUE(found.complete) << quarter << ' ' << off;
        EXPECT_FALSE(found.capped);
        EXPECT_NEAR(found.lower, 1, 0.01) << "the ball's pole, or the prism's side";
        EXPECT_LT(found.points, 1'000U * static_cast<unsigned>(quarter)) << quarter << ' ' << off;
      }
    }
  }
}

TEST(Penetration, OfFacesOnEachOtherEnds) {
  Bodies bodies(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}));
  for (const Vector& at : {Vector(0, 0, 1), Vector(0.3, 0.2, 1), Vector(1, 0.5, 0.5)}) {
    const Penetration found = bodies.at(place(at), 1e-6);
    EXPECT_TRUE(found.complete) << at.transpose();
    EXPECT_EQ(found.lower, 0);
    EXPECT_LE(found.upper, 1e-6);
    EXPECT_LT(found.points, 10'000U);
  }
}

// All points of a line are equally deep, half-way between two faces. A piece of a face on that line
// has a loose bound until it is as small as the tolerance: 80 million pieces.
TEST(Penetration, SaysThatItEndedAtTheCap) {
  IST_SLOW();
  const TriangleMesh bar = box({-5, -1, -1}, {5, 1, 1}),
                     plate = box({-4, -0.31, -0.3}, {4, 0.7, 0});
  Bodies bodies(turned(bar, askew()), turned(plate, askew()));
  const Penetration found = bodies.at(Pose::Identity(), 1e-7);
  EXPECT_TRUE(found.capped);
  EXPECT_FALSE(found.complete);
  EXPECT_LE(found.lower, 1);
  EXPECT_GE(found.upper, 1);
  EXPECT_GT(found.upper - found.lower, 1e-7);
  EXPECT_LT(found.upper - found.lower, 1e-3);
}

TEST(Penetration, DoesNotDependOnEarlierQuestions) {
  const auto bodies = [] { return Bodies(cylinder(100, 1, 20), icosphere(3, 1)); };
  const Pose poses[] = {place({1, 0, 10}), place({0, 0, 10}), place({0.5, 0.2, 0})};
  PenetrationOptions few;
  few.budget.tests = 50;
  for (const Pose& pose : poses) {
    Bodies fresh = bodies(), used = bodies();
    const Penetration truth = fresh.at(pose, 1e-3);
    for (const Pose& before : poses) {
      static_cast<void>(used.at(before, 1e-4, few));
      static_cast<void>(used.at(before, 1e-2));
      static_cast<void>(used.query.distance(before, 1e-3));
      const Penetration found = used.at(pose, 1e-3);
      EXPECT_EQ(found.lower, truth.lower);
      EXPECT_EQ(found.upper, truth.upper);
      EXPECT_EQ(found.complete, truth.complete);
      EXPECT_EQ(found.capped, truth.capped);
      EXPECT_EQ(found.points, truth.points);
      EXPECT_EQ(found.triangle, truth.triangle);
    }
  }
}

TEST(Penetration, SaysWhatIsNoQuestion) {
  const TriangleMesh closed = box({0, 0, 0}, {1, 1, 1});
  Bodies open_fixed(open_strip(3), closed), open_moving(closed, open_strip(3));
  EXPECT_EQ(open_fixed.at(Pose::Identity(), 0.1).status, DepthStatus::kFixedNotClosed);
  EXPECT_EQ(open_fixed.at(Pose::Identity(), 0.1).upper, HUGE_VAL);
  EXPECT_EQ(open_moving.at(Pose::Identity(), 0.1).status, DepthStatus::kMovingNotClosed);
  Bodies bodies(closed, closed);
  Pose sheared = Pose::Identity();
  sheared(0, 1) = 0.1;
  EXPECT_EQ(bodies.at(sheared, 0.1).status, DepthStatus::kInvalidPose);
  EXPECT_EQ(bodies.at(sheared, 0.1).upper, HUGE_VAL);
  for (const double tolerance : {-1.0, std::nan("")}) {
    EXPECT_EQ(error_name([&] { static_cast<void>(bodies.at(Pose::Identity(), tolerance)); }),
              "argument-invalid");
  }
  const SphereTree bare = build_tree(closed, {.voxel_size = 0.5, .keep_triangles = false});
  Query query(bodies.fixed, bare);
  EXPECT_EQ(error_name([&] { static_cast<void>(penetration(query, Pose::Identity(), 0.1)); }),
            "triangles-missing");
  // Inside out at first: turned outward when the tree was built.
  Bodies turned(closed, inside_out(closed));
  EXPECT_NEAR(turned.at(place({0.75, 0, 0}), 1e-6).lower, 0.25, 1e-6);
  EXPECT_STREQ(to_string(DepthStatus::kMovingNotClosed), "moving-not-closed");
}

}  // namespace
}  // namespace ist::test
