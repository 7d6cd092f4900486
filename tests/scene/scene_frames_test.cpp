// The same scene elsewhere, turned, or in another unit is felt the same.

#include <gtest/gtest.h>

#include "haptics/bodies/body_cases.h"
#include "query/query_cases.h"
#include "scene/scene_case.h"
#include "support/effort.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr int kTicks = 700;

// A box that is put on a larger one, tilted, and pushed along; with all that is felt at contacts.
Scene tilted_scene() {
  Scene scene{.unit = 1e-3};
  scene.fixed = {box_body("box", {-15, -10, -3}, {15, 10, 3})};
  scene.held = {ball_body("ball", {1, 2, 7.5}, 4)};
  scene.device =
      ScriptSettings{kDeviceUnderTest,
                     {},
                     {{0, {}},
                      {0.4, {Eigen::Matrix3d::Identity(), Vector3d(0, 0, -1.5e-3)}},
                      {1, {Eigen::Matrix3d::Identity(), Vector3d(4e-3, 1e-3, -1.5e-3)}}}};
  scene.coupling = {1000, 0.5, 1, 5e-4, 5, 0.2};
  scene.safety = {8, 0.3, 500, 20, 0.1};
  scene.springs = SpringsSettings{.stiffness = 20000};
  scene.damping = DampingSettings{10};
  return scene;
}

std::vector<Vector6> felt(const Scene& scene) {
  const BuiltScene built = build_scene(scene);
  std::vector<Vector6> wrenches;
  for (int i = 0; i < kTicks; ++i) {
    const Tick tick = built.simulation->tick(built.device->read(), {});
    built.device->write(tick.wrench, built.simulation->dt());
    EXPECT_FALSE(tick.fault || tick.held);
    wrenches.push_back(tick.wrench);
  }
  return wrenches;
}

// To within 3 mN of some newtons, in every tick. One answer is the same to 1e-9 (ToolContactQuery),
// but which points are joined, and when what sticks begins to slide, may hang on a rounding.
void expect_same(const std::vector<Vector6>& a, const std::vector<Vector6>& b) {
  double force = 0, torque = 0, most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    force = std::max(force, (a[i] - b[i]).head<3>().norm());
    torque = std::max(torque, (a[i] - b[i]).tail<3>().norm());
    most = std::max(most, a[i].head<3>().norm());
  }
  EXPECT_GT(most, 0.5);  // something was felt
  EXPECT_LT(force, 3e-3);
  EXPECT_LT(torque, 1e-4);
}

TEST(SceneFrames, ATurnedAndMovedSceneIsFeltTurned) {
  const Scene plain = tilted_scene();
  const std::vector<Vector6> expected = felt(plain);
  Random random(6);
  for (int i = 0; i < samples(2); ++i) {
    const Eigen::Matrix3d turn = random.rotation();
    const Vector3d way = random.point(-200, 200);  // mm
    Scene moved = plain;
    for (SceneBody* body : {&moved.fixed.front(), &moved.held.front()}) {
      body->translation = turn * body->translation + way;
      body->rotation = turn * body->rotation;
    }
    for (Waypoint& waypoint : std::get<ScriptSettings>(moved.device).plan) {
      waypoint.pose.translation = turn * waypoint.pose.translation;
      waypoint.pose.rotation = turn * waypoint.pose.rotation * turn.transpose();
    }
    std::vector<Vector6> back = felt(moved);
    for (Vector6& wrench : back) {
      wrench.head<3>() = (turn.transpose() * wrench.head<3>()).eval();
      wrench.tail<3>() = (turn.transpose() * wrench.tail<3>()).eval();
    }
    expect_same(expected, back);
  }
}

// Lengths of bodies are in the scene's unit; all else is SI already.
TEST(SceneFrames, AnotherUnitIsFeltTheSame) {
  const Scene plain = tilted_scene();
  const std::vector<Vector6> expected = felt(plain);
  for (const double unit : {1.0, 0.0254}) {
    SCOPED_TRACE(unit);
    Scene scaled = plain;
    const double scale = plain.unit / unit;
    scaled.unit = unit;
    for (SceneBody* body : {&scaled.fixed.front(), &scaled.held.front()}) {
      auto& shape = std::get<BuiltInShape>(body->source);
      shape.size *= scale;
      shape.radius *= scale;
      *body->voxel_size *= scale;
      body->translation *= scale;
    }
    expect_same(expected, felt(scaled));
  }
}

// A caller turns poses of the tool into poses of the held mesh by this origin.
TEST(SceneFrames, TheOriginPlacesTheHeldMesh) {
  const Scene plain = tilted_scene();
  for (const std::optional<Vector3d>& named :
       {std::optional<Vector3d>(), std::optional<Vector3d>(Vector3d(1, -2, 3))}) {
    Scene scene = plain;
    scene.origin = named;
    const BuiltScene built = build_scene(scene);
    const SceneBody& held = scene.held.front();
    if (named) {
      EXPECT_EQ(built.origin, *named);
    }
    const Vector3d origin = scene.unit * (held.rotation * built.origin + held.translation);
    EXPECT_LT((built.simulation->tool_pose().translation - origin).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace ist::test
