// Slow motion: what an answer may change by from one small step to the next.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "ist/mesh/mesh.h"
#include "query/query_cases.h"
#include "query/triangles/mesh_distance.h"
#include "query/triangles/triangle_tree.h"
#include "stability/sweep.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kStep = 1e-4;  // mm

// A body with its triangles and without.
struct Body {
  Body(const TriangleMesh& mesh, double voxel_size)
      : exact(tree_with_triangles(mesh, voxel_size)), plain(without_triangles(exact)) {}
  SphereTree exact, plain;
};

// How far along `direction` the last contact of leaves is, and the last of triangles: from where
// the bodies touch.
struct LastTouch {
  double leaves, triangles;
};
LastTouch last_touch(const Body& fixed, const Body& moving, SpherePolicy policy,
                     const Isometry3d& from, const Vector3d& direction, double far) {
  QueryOptions options;
  options.policy = policy;
  Query query(fixed.plain, moving.plain, options), exact(fixed.exact, moving.exact);
  const auto at = [&](double t) { return shift(t * direction) * from; };
  return {
      last_touching(0, far, [&](double t) { return query.leaf_pairs(at(t), {}).leaf_pairs > 0; }),
      last_touching(0, far,
                    [&](double t) { return exact.intersects(at(t)).answer == ist::Answer::kYes; })};
}

// Through the first contact of leaves, in steps of 1e-4 mm and in parts of the pad; through that of
// triangles; where they are closed; and turning.
std::size_t sweep_all(const Body& fixed, const Body& moving, SpherePolicy policy,
                      const Isometry3d& from, const Vector3d& direction, double far, int steps,
                      MotionCases& cases) {
  Sweep sweep(fixed.exact, moving.exact, fixed.plain, moving.plain, policy, cases);
  const LastTouch last = last_touch(fixed, moving, policy, from, direction, far);
  const auto at = [&](double t) { return shift(t * direction) * from; };
  sweep.along(line(at(last.leaves + steps / 2 * kStep), -direction, kStep, steps));
  const double fine = 0x1p-26 * sweep.lever();
  sweep.along(line(at(last.leaves + steps / 2 * fine), -direction, fine, steps));
  sweep.along(line(at(last.triangles + steps / 2 * kStep), -direction, kStep, steps));
  sweep.along(line(from, -direction, kStep, steps));
  const Vector3d centre = moving.plain.origin();
  for (const Vector3d& axis :
       {direction, Vector3d(direction.cross(Vector3d(1, 2, 3)).normalized())})
    for (const double t : {last.leaves, last.triangles, 0.0})
      sweep.along(turn(at(t), axis, centre, sweep.lever(), moving.plain.bounding_radius(), kStep,
                       steps / 2));
  return sweep.changes();
}

class Motion : public ::testing::TestWithParam<SpherePolicy> {};

INSTANTIATE_TEST_SUITE_P(Policies, Motion, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(Motion, ThroughFirstContactsChangesNoFasterThanItsRates) {
  MotionCases cases("first contact of balls", GetParam());
  const Body ball(icosphere(2, 2), 0.5), other(moved(icosphere(1, 1.5), {0.1, 0.2, 0.3}), 0.4);
  const Isometry3d turned = pose_of(Random(3).rotation(), {0.3, 0.2, 1});
  EXPECT_GT(sweep_all(ball, other, GetParam(), turned, Vector3d(1, -2, 6).normalized(), 9,
                      samples(300), cases),
            1u);
}

// Faces in planes of both lattices: moved across them, along them, and tilted from them.
TEST_P(Motion, OfFacesOnLatticePlanesChangesNoFasterThanItsRates) {
  MotionCases cases("faces on lattice planes", GetParam());
  const Body block(box({-2, -2, -1}, {2, 2, 1}), 0.5), cube(box({-1, -1, -1}, {1, 1, 1}), 0.5);
  const Vector3d x = Vector3d::UnitX(), z = Vector3d::UnitZ();
  EXPECT_GT(sweep_all(block, cube, GetParam(), shift({0, 0, 1}), z, 9, samples(200), cases),
            least(10u, 1u));
  Sweep sweep(block.exact, cube.exact, block.plain, cube.plain, GetParam(), cases);
  // Along a face from one voxel's edge over the next: 0.5 mm in coarser steps.
  sweep.along(line(shift({0.24, 0, 2}), x, 0.5 / samples(100), samples(100)));
  sweep.along(line(shift({0.5 - 50 * kStep, 0, 2}), x, kStep, 100));
  sweep.along(
      line(shift({0.5 - 50 * kStep, 0.5, 2.5}), Vector3d(1, 1, -1) / std::sqrt(3.0), kStep, 100));
  sweep.along(turn(shift({0.5, 0, 2}), x, cube.plain.origin(), sweep.lever(),
                   cube.plain.bounding_radius(), kStep, 100));
  EXPECT_GT(sweep.changes(), 10u);
}

// The intervals of one pose at two voxel sizes, in every policy, with triangles and without, ended
// early or not: each holds the distance, so any two have a point in common.
class TwoSizes {
 public:
  explicit TwoSizes(const std::string& of)
      : truth_("motion", of + ", gap at s and s/2", "mm that the distance is outside an interval"),
        common_("motion", of + ", gap at s and s/2: in common", "mm between two intervals") {}

  struct At {
    Isometry3d pose;
    double distance;
    double error;  // what the distances are right to
  };
  void check(const std::vector<const Body*>& fixed, const std::vector<const Body*>& moving,
             const std::vector<At>& poses) {
    std::vector<DistanceInterval> common(poses.size(), {0, HUGE_VAL});
    const auto ask_all = [&](Query& query) {
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto& [pose, distance, error] = poses[i];
        std::vector<DistanceInterval> found = {query.distance(pose, 0).distance};
        for (const std::uint64_t tests : {1u, 30u, 300u}) {
          found.push_back(*query.leaf_pairs(pose, {}, {.tests = tests}).distance);
        }
        for (const DistanceInterval& gap : found) {
          truth_.sample(outside(gap, distance), error);
          common[i] = {std::max(common[i].lower, gap.lower), std::min(common[i].upper, gap.upper)};
        }
      }
    };
    for (std::size_t i = 0; i < fixed.size(); ++i) {
      for (const SpherePolicy policy : kSpherePolicies) {
        QueryOptions options;
        options.policy = policy;
        Query exact(fixed[i]->exact, moving[i]->exact, options),
            plain(fixed[i]->plain, moving[i]->plain, options);
        ask_all(exact);
        ask_all(plain);
      }
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
      common_.sample(std::max(0.0, common[i].lower - common[i].upper), 0);
    }
  }

 private:
  StabilityCase truth_, common_;
};

TEST(GapsOfTwoVoxelSizes, Intersect) {
  TwoSizes sizes("random bodies");
  for (int seed = 0; seed < samples(16); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(6000 + static_cast<std::uint64_t>(seed));
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const double s = random.uniform(0.1, 0.8), t = random.uniform(0.1, 0.8);
    const Body a1(a, s), a2(a, s / 2), b1(b, t), b2(b, t / 2);
    std::vector<TwoSizes::At> poses;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Matrix3d rotation = random.rotation();
      const Vector3d on_a = a.vertices[random.below(a.vertices.size())];
      const Vector3d on_b = b.vertices[random.below(b.vertices.size())];
      const Isometry3d pose =
          pose_of(rotation, on_a - rotation * on_b + i * random.uniform(0, 1) * random.direction());
      const double distance = mesh_distance(a, b, pose);
      // No edge is longer than 6; and a vertex is moved to within less than 1e-14.
      poses.push_back({pose, distance, kTriangleDistanceError * (6 + distance) + 1e-14});
    }
    sizes.check({&a1, &a2}, {&b1, &b2}, poses);
  }
}

// Two jaws of one patient, in voxels of 1.6 mm.
TEST(MotionOfRealJaws, ChangesNoFasterThanItsRates) {
  IST_SLOW();
  const auto upper = data_dir() / "human_maxilla.stl", lower = data_dir() / "human_mandible.stl";
  if (!std::filesystem::exists(upper)) IST_SKIP(upper << " is not there");
  const TriangleMesh maxilla = read_mesh(upper), mandible = read_mesh(lower);
  const Body fixed(maxilla, 1.6), moving(mandible, 1.6);
  const Vector3d down = -Vector3d::UnitZ();
  Isometry3d from = Isometry3d::Identity();
  from.linear() = Eigen::AngleAxisd(0.0003, Vector3d::UnitZ()).toRotationMatrix();
  for (const SpherePolicy policy : kSpherePolicies) {
    SCOPED_TRACE(to_string(policy));
    MotionCases cases("real jaws", policy);
    EXPECT_GT(sweep_all(fixed, moving, policy, from, down, 60, samples(10), cases), 1u);
  }
}

// The same jaws: the distances were found by three other libraries, which agree.
TEST(GapsOfTwoVoxelSizes, OfRealJawsIntersect) {
  IST_SLOW();
  const auto truth_file = data_dir() / "truth_human.json";
  if (!std::filesystem::exists(truth_file)) IST_SKIP(truth_file << " is not there");
  constexpr double kTruthError = 1e-5;  // mm
  const TriangleMesh maxilla = read_mesh(data_dir() / "human_maxilla.stl"),
                     mandible = read_mesh(data_dir() / "human_mandible.stl");
  std::vector<TwoSizes::At> poses;
  int apart = 0;
  for (const nlohmann::json& item : nlohmann::json::parse(std::ifstream(truth_file))) {
    const auto numbers = item["pose"].get<std::vector<double>>();
    Isometry3d pose;
    std::copy(numbers.begin(), numbers.end(), pose.matrix().data());
    const auto distance = item["distance"].get<double>();
    poses.push_back({pose, distance, kTruthError});
    apart += distance > 0 ? 1 : 0;
  }
  ASSERT_EQ(poses.size(), 12u);
  EXPECT_EQ(apart, 6);
  const Body fixed(maxilla, 1.6), moving(mandible, 1.6);
  const Body coarse_fixed(maxilla, 3.2), coarse_moving(mandible, 3.2);
  TwoSizes("real jaws").check({&fixed, &coarse_fixed}, {&moving, &coarse_moving}, poses);
}

}  // namespace
}  // namespace ist::test
