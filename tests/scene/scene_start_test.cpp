// Where a scene starts: free, or opened along the axis that it names, or refused.

#include <gtest/gtest.h>

#include "ist/base/error.h"
#include "scene/scene_case.h"
#include "support/errors.h"

namespace ist::test {
namespace {

// The hand begins `move` away from where the ball is 0 to 5 above the box's middle.
std::string starting(std::string_view move, std::string_view held = "") {
  std::string text = replaced(kSoundScene, "move = [0, 0, 0]", "move = " + std::string(move));
  return replaced(text, "[device]\n", std::string(held) + "[device]\n");
}

class SceneStart : public SceneCase {
 protected:
  // At `line` of the scene: that of [held], if it names no axis.
  void expect_refused(std::string_view text, std::string_view what, std::string_view remedy,
                      int line = 7) const {
    const std::optional<Error> error = error_of([&] { static_cast<void>(built(text)); });
    ASSERT_TRUE(error) << "it is built";
    EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
    const std::string place = (dir_.path() / "scene.toml:").string() + std::to_string(line) + ": ";
    EXPECT_TRUE(std::string_view(error->what()).starts_with(place)) << error->what();
    for (const std::string_view part : {what, remedy}) {
      EXPECT_NE(std::string_view(error->what()).find(part), std::string_view::npos)
          << error->what();
    }
  }
  // Of the tool at the first tick, m.
  [[nodiscard]] static Eigen::Vector3d start_of(const BuiltScene& scene) {
    return scene.simulation->tick(std::nullopt, {}).tool.translation;
  }
};

TEST_F(SceneStart, IsWhereTheDeviceStarts) {
  const BuiltScene scene = built(starting("[1, 2, 30]"));
  EXPECT_TRUE(scene.warnings.empty());
  const Placement device = *scene.device->read();
  EXPECT_LT((start_of(scene) - device.translation).norm(), 1e-15);
  // The grid's centre is not the ball's, but both moved alike.
  const BuiltScene higher = built(starting("[1, 2, 31]"));
  EXPECT_LT((start_of(higher) - start_of(scene) - Eigen::Vector3d(0, 0, 1e-3)).norm(), 1e-15);
}

TEST_F(SceneStart, ThatTouchesIsRefusedWithARemedy) {
  expect_refused(starting("[0, 0, 9]"), "the bodies intersect",
                 "open = \"-z\", or start elsewhere");
}

// The ball of 5 in the box of 40 x 40 x 10 touches its faces; one of 2 does not, and is inside.
TEST_F(SceneStart, InsideTheOtherBodyIsRefused) {
  const std::string small = replaced(starting("[0, 0, 0]"), "radius = 5", "radius = 2");
  expect_refused(small, "one body is inside the other", "open = \"-z\"");
  expect_refused(replaced(replaced(small, "shape = \"box\"\nsize = [40, 40, 10]",
                                   "shape = \"sphere\"\nradius = 12"),
                          "radius = 2", "radius = 4"),
                 "one body is inside the other", "start elsewhere");
  // And round it.
  expect_refused(replaced(replaced(small, "shape = \"box\"\nsize = [40, 40, 10]",
                                   "shape = \"sphere\"\nradius = 3"),
                          "radius = 2", "radius = 9"),
                 "one body is inside the other", "start elsewhere");
}

TEST_F(SceneStart, IsOpenedAlongItsAxisUntilItIsFree) {
  for (const auto& [axis, sign] : {std::pair("z", 1), {"-z", -1}}) {
    const BuiltScene scene = built(starting("[0, 0, 0]", "open = \"" + std::string(axis) + "\"\n"));
    ASSERT_TRUE(warns(scene, "along held.open"));
    const Eigen::Vector3d moved = start_of(scene) - scene.device->read()->translation;
    EXPECT_LT(moved.head<2>().norm(), 1e-15);
    // Half the box and the ball: 10; a voxel or two of the ball's 0.5 more, and one of the box's.
    EXPECT_GT(sign * moved.z(), 10e-3);
    EXPECT_LT(sign * moved.z(), 12.5e-3);
    // It does touch nothing, and a hand that stays away feels only its coupling.
    EXPECT_EQ(scene.simulation->tick(std::nullopt, {}).contacts->leaf_pairs, 0u);
  }
}

TEST_F(SceneStart, ThatIsFreeIsNotOpened) {
  const BuiltScene scene = built(starting("[0, 0, 15]", "open = \"x\"\n"));
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_LT((start_of(scene) - scene.device->read()->translation).norm(), 1e-15);
}

// The ball hangs 5 above the box. The roots alone leave 49 in doubt, what a tick has time for 36.
TEST_F(SceneStart, ThatIsFreeHasADistanceThatTicksTell) {
  const BuiltScene scene = built(starting("[0, 0, 15]"));
  const Tick tick = scene.simulation->tick(scene.device->read(), {});
  ASSERT_TRUE(tick.contacts && tick.contacts->distance);
  EXPECT_LE(tick.contacts->distance->lower, 5.01);  // the ball's facets lie inside it
  EXPECT_GE(tick.contacts->distance->upper, 5);
  EXPECT_LT(tick.contacts->distance->upper - tick.contacts->distance->lower, 60);
}

// A turned fixed body does not turn the axis, which is the scene's.
TEST_F(SceneStart, OpensAlongTheScenesAxis) {
  const BuiltScene scene =
      built(replaced(starting("[0, 0, 0]", "open = \"x\"\n"), "[held]",
                     "quaternion = [0.7071067811865476, 0, 0.7071067811865476, 0]\n[held]"));
  const Eigen::Vector3d moved = start_of(scene) - scene.device->read()->translation;
  EXPECT_LT(moved.tail<2>().norm(), 1e-15);
  EXPECT_GT(moved.x(), 10e-3);  // its thickness lies along x now
  EXPECT_LT(moved.x(), 12.5e-3);
}

// However far that is: inside a box, where nothing touches, the tool is not free yet.
TEST_F(SceneStart, IsOpenedThroughAWholeBodyWhereItsAxisLeadsThere) {
  const std::string small =
      replaced(starting("[0, 0, 0]", "open = \"-x\"\n"), "radius = 5", "radius = 2");
  const BuiltScene scene = built(small);
  EXPECT_TRUE(warns(scene, "one body is inside the other"));
  const Eigen::Vector3d moved = start_of(scene) - scene.device->read()->translation;
  EXPECT_LT(moved.x(), -22e-3);
  EXPECT_GT(moved.x(), -24.5e-3);
}

TEST_F(SceneStart, WithoutContactsIsNotLookedAt) {
  const BuiltScene scene =
      built(replaced(starting("[0, 0, 0]"), "[effects.springs]\nstiffness = 20000\n",
                     "[effects.gravity]\nmass = 0.1\n"));
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_FALSE(note_of(scene, "free start").built);
}

}  // namespace
}  // namespace ist::test
