#include "loop/haptics/bodies/tool_contact_query.h"

#include <gtest/gtest.h>

#include <cmath>

#include "haptics/effects/effect_case.h"
#include "ist/tree/sphere_tree.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

// Millimetres. The box's upper face is z = 0 of its mesh.
constexpr double kUnit = 1e-3, kRadius = 5, kVoxel = 0.5;

SphereTree voxels_of(const TriangleMesh& mesh) {
  BuildOptions options;
  options.voxel_size = kVoxel;
  return build_tree(mesh, options);
}

const SphereTree& block() {
  static const SphereTree tree = voxels_of(box({-10, -10, -4}, {10, 10, 0}));
  return tree;
}
// Its centre is not that of its grid, which the tool's origin is.
const SphereTree& ball() {
  static const SphereTree tree = voxels_of(moved(icosphere(4, kRadius), {7, 8, 9}));
  return tree;
}
const Vector3d kCentre(7, 8, 9);  // of the ball, in its mesh

// Where the ball's mesh is, in the box's mesh, when it is pressed by `depth`, mesh units.
Placement pressed(double depth, const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
  return {turn, Vector3d(0.1, -0.2, kRadius - depth) - turn * kCentre};
}

struct Scenery {
  Placement fixed;  // SI
  BodyFrames frames{kUnit, fixed, ball().origin()};

  // Of the tool in the scene, where the held mesh is at `held` in the fixed one, mesh units.
  [[nodiscard]] Placement tool(const Placement& held) const {
    const Vector3d origin = held.rotation * frames.tool_origin + held.translation;
    return {fixed.rotation * held.rotation, fixed.rotation * (kUnit * origin) + fixed.translation};
  }
  [[nodiscard]] ToolContacts contacts(const Placement& held, double margin = 0.5) const {
    ToolContactQuery query(block(), ball(), frames, {SpherePolicy::kSlab, margin});
    ToolContacts contacts;
    EXPECT_TRUE(query.find(tool(held), {}, contacts).complete);
    return contacts;
  }
};

std::vector<Placement> placements() {
  Random random(3);
  std::vector<Placement> all{Placement()};
  for (int i = 0; i < 6; ++i) all.push_back({random.rotation(), random.point(-0.3, 0.3)});
  return all;
}

TEST(BodyFrames, PutThePoseAndItsPointsWhereTheyAreInTheScene) {
  Random random(4);
  for (const Placement& fixed : placements()) {
    const Scenery scenery{fixed};
    const Placement tool{random.rotation(), random.point(-0.2, 0.2)};
    const Eigen::Isometry3d pose = scenery.frames.query_pose(tool);
    for (int i = 0; i < samples(10); ++i) {
      const Vector3d point = random.point(-10, 10);  // of the held mesh
      const Vector3d in_scene =
          tool.rotation * (kUnit * (point - scenery.frames.tool_origin)) + tool.translation;
      EXPECT_LT((scenery.frames.to_scene(pose * point) - in_scene).norm(), 1e-15);
    }
  }
}

// A ball of radius R pressed by d into a plane: the deepest place is below its centre, all are
// within sqrt(2 R d) of it, each normal is the plane's, and no force has a torque about the centre.
TEST(ToolContactQuery, OfABallOnABoxIsItsClosedForm) {
  for (const double depth : {0.1, 0.3, 0.5}) {
    for (const Placement& fixed : placements()) {
      const Scenery scenery{fixed};
      const Placement held = pressed(depth);
      const ToolContacts contacts = scenery.contacts(held);
      const Vector3d up = fixed.rotation * Vector3d::UnitZ();
      const Vector3d centre =  // of the ball, from the tool's origin
          scenery.tool(held).rotation * (kUnit * (kCentre - scenery.frames.tool_origin));
      // Springs begin half a voxel before the surfaces meet.
      const double overlap = kUnit * (depth + 0.5 * kVoxel);
      const double wide = std::sqrt(2 * kUnit * kRadius * overlap) + kUnit * kVoxel;
      double deepest = 0;
      ASSERT_GT(contacts.points().size(), 4u);
      for (const ToolContact& point : contacts.points()) {
        EXPECT_NEAR(point.normal.norm(), 1, 1e-12);
        EXPECT_GT(point.normal.dot(up), 0.9);
        const Vector3d from = point.arm - centre;
        EXPECT_NEAR(from.dot(up), kUnit * (depth - kRadius), kUnit * kVoxel);  // the plane
        EXPECT_LT((from - from.dot(up) * up).norm(), wide);
        deepest = std::max(deepest, point.depth);
      }
      EXPECT_NEAR(deepest, overlap, 0.5 * kUnit * kVoxel);
      const Vector3d force = contacts.spring.head<3>(), torque = contacts.spring.tail<3>();
      EXPECT_GT(force.dot(up), 0);
      EXPECT_LT((force - force.dot(up) * up).norm(), 0.03 * force.norm());
      EXPECT_LT((torque - centre.cross(force)).norm(), 0.03 * kUnit * kRadius * force.norm());
    }
  }
}

// The same pose of the bodies to each other is the same touch, wherever the scene has them.
TEST(ToolContactQuery, TurnsWithTheScene) {
  Random random(8);
  for (int i = 0; i < samples(8); ++i) {
    const Placement held = pressed(0.4, random.rotation());
    const Scenery plain{Placement()};
    const ToolContacts expected = plain.contacts(held);
    for (const Placement& fixed : placements()) {
      const ToolContacts found = Scenery{fixed}.contacts(held);
      EXPECT_NEAR(found.count, expected.count, 1e-9 * expected.count);
      const Vector3d force = fixed.rotation * expected.spring.head<3>();
      const Vector3d torque = fixed.rotation * expected.spring.tail<3>();
      EXPECT_LT((found.spring.head<3>() - force).norm(), 1e-9 * force.norm());
      EXPECT_LT((found.spring.tail<3>() - torque).norm(), 1e-9 * kUnit * kRadius * force.norm());
    }
  }
}

// Points are merged pairs, so what they come to differs from the sum over pairs: here by 0.5 % of
// the force, and 0.7 % of the torque that it has at the ball's radius, at most.
TEST(ToolContactQuery, ItsPointsComeToTheWrenchOfAllPairs) {
  Random random(9);
  double worst_force = 0, worst_torque = 0;
  for (int i = 0; i < samples(30); ++i) {
    const ToolContacts contacts = Scenery{placements()[static_cast<std::size_t>(i % 7)]}.contacts(
        pressed(random.uniform(0.05, 0.5), random.rotation()));
    Vector6 sum = Vector6::Zero();
    double fractions = 0;
    for (const ToolContact& point : contacts.points()) {
      sum +=
          point.stiffness_fraction * point.depth * six(point.normal, point.arm.cross(point.normal));
      fractions += point.stiffness_fraction;
    }
    const double force = contacts.spring.head<3>().norm();
    worst_force = std::max(worst_force, (sum - contacts.spring).head<3>().norm() / force);
    worst_torque = std::max(worst_torque,
                            (sum - contacts.spring).tail<3>().norm() / (kUnit * kRadius * force));
    // Ten pairs have the whole stiffness.
    EXPECT_NEAR(fractions, std::min(0.1 * contacts.count, 1.0), 1e-9 * contacts.count);
  }
  RecordProperty("worst_force", std::to_string(worst_force));
  RecordProperty("worst_torque", std::to_string(worst_torque));
  EXPECT_LT(worst_force, 0.02);
  EXPECT_LT(worst_torque, 0.02);
}

// A block of 6 mm by 6 mm on a larger one, 0.1 mm deep.
ToolContacts of_blocks(double voxel_size, double full_area) {
  const SphereTree fixed = build_tree(box({-10, -10, -4}, {10, 10, 0}), {.voxel_size = voxel_size});
  const SphereTree held = build_tree(box({-3, -3, -0.1}, {3, 3, 3}), {.voxel_size = voxel_size});
  ToolContactQuery query(fixed, held, {kUnit, {}, held.origin()},
                         {.policy = SpherePolicy::kSlab,
                          .margin = 0,
                          .full_area = full_area / (voxel_size * voxel_size)});
  ToolContacts contacts;
  const Placement tool{Eigen::Matrix3d::Identity(), kUnit * held.origin()};
  EXPECT_TRUE(query.find(tool, {}, contacts).complete);
  return contacts;
}

// The spring of a stiffness of 1 N/m is the mean depth, whatever the voxel size.
TEST(ToolContactQuery, Stiffness_DoesNotDependOnTheVoxelSize) {
  for (const double voxel_size : {0.2, 0.4, 0.8}) {
    const double depth = of_blocks(voxel_size, 1).spring[2] / kUnit;
    EXPECT_NEAR(depth, 0.1, 0.02) << voxel_size;
  }
}

// Below the full area the spring is in proportion to the area of the contact.
TEST(ToolContactQuery, Stiffness_FollowsTheAreaOfASmallContact) {
  const ToolContacts whole = of_blocks(0.4, 1), part = of_blocks(0.4, 400);
  const double area = 0.4 * 0.4 * whole.count;  // mm²
  ASSERT_GT(area, 1);
  ASSERT_LT(area, 400);
  EXPECT_NEAR(part.spring[2], area / 400 * whole.spring[2], 1e-9 * whole.spring[2]);
}

TEST(ToolContactQuery, KeepsWhatItKnewWhereTheAnswerIsNotComplete) {
  const Scenery scenery{Placement()};
  ToolContactQuery query(block(), ball(), scenery.frames, {SpherePolicy::kSlab});
  ToolContacts contacts;
  ASSERT_TRUE(query.find(scenery.tool(pressed(0.3)), {}, contacts).complete);
  const ToolContacts before = contacts;
  ToolContacts of_another;
  ToolContactQuery other(block(), ball(), scenery.frames, {SpherePolicy::kSlab});
  const std::uint64_t needed = other.find(scenery.tool(pressed(0.5)), {}, of_another).sphere_tests;
  for (const std::uint64_t tests : {std::uint64_t{10}, needed / 2, needed - 1}) {
    ToolContactQuery stopped(block(), ball(), scenery.frames, {SpherePolicy::kSlab});
    Budget few;
    few.tests = tests;
    EXPECT_FALSE(stopped.find(scenery.tool(pressed(0.5)), few, contacts).complete);
    EXPECT_EQ(contacts.spring, before.spring) << tests;
    EXPECT_EQ(contacts.count, before.count) << tests;
    EXPECT_EQ(contacts.points().size(), before.points().size()) << tests;
    EXPECT_EQ(contacts.pairs().size(), before.pairs().size()) << tests;
  }
  contacts.clear();
  EXPECT_TRUE(query.find(scenery.tool(pressed(-2)), {}, contacts).complete);
  EXPECT_EQ(contacts.count, 0);
  EXPECT_TRUE(contacts.points().empty());
  EXPECT_EQ(contacts.spring, Vector6(Vector6::Zero()));
}

// Where the tool is apart, the distance is a clearance that holds the true one at every tick, and
// most ticks need no search.
TEST(ToolContactQuery, TellsAClearanceWhereNothingIsTouched) {
  const Scenery scenery{Placement()};
  ToolContacts contacts;
  ToolContactQuery query(block(), ball(), scenery.frames, {.policy = SpherePolicy::kSlab});
  int clear = 0;
  double lowest = 1;
  for (int i = 0; i <= 400; ++i) {
    const double gap = 1.6 - 2e-3 * i;
    contacts.clear();
    const QueryResult result = query.find(scenery.tool(pressed(-gap)), {}, contacts);
    ASSERT_TRUE(result.complete);
    ASSERT_EQ(result.leaf_pairs, 0u);
    EXPECT_LE(result.distance->lower, gap + 0.01);  // the facets lie inside the ball
    EXPECT_GE(result.distance->upper, gap);
    if (result.found != Found::kClear) continue;
    ++clear;
    lowest = std::min(lowest, result.distance->lower);
  }
  EXPECT_GT(clear, 300);
  EXPECT_GT(lowest, 0);
}

// By trees with triangles and without, and with a cache or none.
TEST(ToolContactQuery, TellsItsMemoryBeforeItIsReserved) {
  const SphereTree plain = tree_of(icosphere(3, kRadius), 12);
  for (const SphereTree* held : {&ball(), &plain}) {
    for (const int workers : {1, 2}) {
      for (const std::size_t front_pairs : {0u, 4097u}) {
        const ToolContactOptions options{
            .policy = SpherePolicy::kTight, .workers = workers, .front_pairs = front_pairs};
        const ToolContactQuery query(block(), *held, {kUnit, {}, held->origin()}, options);
        EXPECT_EQ(ToolContactQuery::bytes_for(block(), *held, options), query.bytes());
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
