// A fixed body that follows a script pushes the tool.

#include <gtest/gtest.h>

#include "haptics/bodies/body_cases.h"
#include "ist/base/error.h"
#include "ist/haptics/simulation.h"
#include "support/errors.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

// A plate under the ball that a hand holds, 1 mm below it, which moves by `way` mm in a second.
Scene driven(const Vector3d& way, Keeps keeps = Keeps::kSprings) {
  Scene scene{.unit = 1e-3};
  scene.fixed = {box_body("plate", {-30, -30, -8}, {30, 30, 0})};
  scene.fixed.front().script = {{0, {}}, {1, {Eigen::Matrix3d::Identity(), 1e-3 * way}}};
  scene.held = {ball_body("tool", {0, 0, 6}, 5)};
  scene.device = NullSettings{kDeviceUnderTest};
  keep_apart(scene, keeps);
  return scene;
}

class DrivenBody : public ::testing::TestWithParam<Keeps> {};
INSTANTIATE_TEST_SUITE_P(, DrivenBody, ::testing::Values(Keeps::kContact, Keeps::kSprings),
                         name_of);

TEST_P(DrivenBody, PushesTheTool) {
  const BuiltScene built = build_scene(driven({0, 0, 4}, GetParam()));
  const Placement start = built.simulation->tool_pose();
  Tick tick{};
  for (int i = 0; i < 1200; ++i) tick = built.simulation->tick(start);
  EXPECT_GT(tick.wrench[2], 0.5);
  EXPECT_GT(built.simulation->tool_pose().translation.z() - start.translation.z(), 1e-3);
  EXPECT_NEAR(built.simulation->body_pose(0).translation.z(), 0, 1e-12) << "4 mm up from -4 mm";
}

// While an answer is missing the tool is held, and the plate waits for it.
TEST_P(DrivenBody, WaitsWhileTheToolIsHeld) {
  const BuiltScene built = build_scene(driven({0, 0, 4}, GetParam()));
  const Placement start = built.simulation->tool_pose();
  Vector3d before = Vector3d::Zero();
  for (int i = 0; i < 600; ++i) {
    before = built.simulation->body_pose(0).translation;
    static_cast<void>(built.simulation->tick(start));
  }
  EXPECT_GT(built.simulation->body_pose(0).translation.z(), before.z());
  TickBudget none;
  none.contacts.tests = 0;
  // A tool that moves with the plate needs no search.
  while (!built.simulation->tick(start, none).held) {
    before = built.simulation->body_pose(0).translation;
    ASSERT_LT(before.z(), -1e-3);
  }
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(built.simulation->tick(start, none).held);
  EXPECT_EQ(built.simulation->body_pose(0).translation, before) << "back with the tool";
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(built.simulation->tick(start).held);
  EXPECT_GT(built.simulation->body_pose(0).translation.z(), before.z());
}

TEST(DrivenScene, ThatJumpsIsRefusedWithSprings) {
  Scene scene = driven({0, 0, 4});
  scene.fixed.front().script.back().time = 0.005;
  const auto error = error_of([&] { static_cast<void>(build_scene(scene)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  EXPECT_NE(std::string(error->what()).find("give the motion more time"), std::string::npos)
      << error->what();
}

TEST(DrivenScene, IsNotForTheHand) {
  Scene scene = driven({0, 0, 4});
  scene.fixed.front().attachable = true;
  const auto error = error_of([&] { static_cast<void>(build_scene(scene)); });
  ASSERT_TRUE(error);
  EXPECT_NE(std::string(error->what()).find("follows a script"), std::string::npos);
  scene = driven({0, 0, 4});
  scene.held.front().script = scene.fixed.front().script;
  ASSERT_TRUE(error_of([&] { static_cast<void>(build_scene(scene)); }));
}

}  // namespace
}  // namespace ist::test
