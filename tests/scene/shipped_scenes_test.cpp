// The scenes that ship with the tests are sound, and hold what they are there for.

#include <gtest/gtest.h>

#include <algorithm>

#include "loop/scene/make_effects.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/scoped_variable.h"

namespace ist::test {
namespace {

Scene shipped(const std::string& name) {
  return read_scene(std::filesystem::path(IST_SCENES) / (name + ".toml"));
}

std::size_t effects(const Scene& scene) { return make_effects(scene, {}, true).size(); }

TEST(ShippedScene, PressesASphereOnABox) {
  const Scene scene = shipped("press");
  EXPECT_TRUE(scene.springs);
  EXPECT_EQ(effects(scene), 1u);
  const double top = 0.5 * std::get<BuiltInShape>(scene.fixed.front().source).size.z();
  const double bottom =
      scene.held.front().translation.z() - std::get<BuiltInShape>(scene.held.front().source).radius;
  EXPECT_GT(bottom, top) << "does not start free";
  const auto& plan = std::get<HandSettings>(scene.device).plan;
  EXPECT_LT(bottom + plan[1].pose.translation.z() / scene.unit, top) << "does not press";
  EXPECT_EQ(scene.seconds, plan.back().time);
}

// The hand holds still there for two seconds: a ball, whose leaf pairs are bound most tightly.
TEST(ShippedScene, RestsStillWhereItPresses) {
  const BuiltScene scene = build_scene(shipped("press"));
  double least = 1e9, most = 0;
  for (int i = 0; i < 2600; ++i) {
    const Tick tick = scene.simulation->tick(scene.device->read(), {});
    scene.device->write(tick.wrench, scene.simulation->dt());
    if (i < 2000) continue;
    least = std::min(least, tick.wrench.head<3>().norm());
    most = std::max(most, tick.wrench.head<3>().norm());
  }
  EXPECT_GT(least, 0.5);
  EXPECT_LT(most - least, 0.01 * most);
}

TEST(ShippedScene, SlidesABoxOverABox) {
  const Scene scene = shipped("slide");
  EXPECT_TRUE(scene.contact && scene.friction && scene.damping);
  EXPECT_EQ(effects(scene), 1u);
  const double top = 0.5 * std::get<BuiltInShape>(scene.fixed.front().source).size.z();
  const double bottom = scene.held.front().translation.z() -
                        0.5 * std::get<BuiltInShape>(scene.held.front().source).size.z();
  EXPECT_GT(bottom, top) << "does not start free";
  const auto& plan = std::get<HandSettings>(scene.device).plan;
  EXPECT_LT(bottom + plan[1].pose.translation.z() / scene.unit, top) << "does not press";
  EXPECT_GT(plan[2].pose.translation.x() - plan[1].pose.translation.x(), 0.01) << "does not slide";
  EXPECT_EQ(scene.seconds, plan.back().time);
}

TEST(ShippedScene, ClosesTwoJawsWithAllEffects) {
  const Scene scene = shipped("jaws");
  EXPECT_EQ(effects(scene), 4u);
  EXPECT_EQ(std::get<BuiltInShape>(scene.fixed.front().source).kind, BuiltInShape::Kind::kUpperJaw);
  EXPECT_EQ(std::get<BuiltInShape>(scene.held.front().source).kind, BuiltInShape::Kind::kLowerJaw);
  // make_jaw() promises that the jaws are free there, and not where the plan leads.
  EXPECT_LE(scene.held.front().translation.z(), -2);
  const auto& plan = std::get<HandSettings>(scene.device).plan;
  EXPECT_GT(scene.held.front().translation.z() + plan[1].pose.translation.z() / scene.unit, -1);
  EXPECT_EQ(scene.seconds, plan.back().time);
}

// A mandible on a splint: free at the start, and all four fixed bodies may be touched.
TEST(ShippedScene, ClosesAMandibleOnASplint) {
  IST_SLOW();
  const Scene scene = shipped("splint");
  ASSERT_EQ(scene.fixed.size(), 4u);
  EXPECT_EQ(std::get<BuiltInShape>(scene.fixed[1].source).kind, BuiltInShape::Kind::kSplint);
  EXPECT_EQ(scene.held.front().translation.z(),
            -std::get<BuiltInShape>(scene.fixed[1].source).opening);
  Scene coarse = scene;
  for (auto* bodies : {&coarse.fixed, &coarse.held}) {
    for (SceneBody& body : *bodies) body.voxel_size = 0.8;
  }
  const BuiltScene built = build_scene(coarse);
  EXPECT_TRUE(built.warnings.empty()) << built.warnings.front();
  double most = 0;
  while (!built.device->done()) {
    const Tick tick = built.simulation->tick(built.device->read());
    built.device->write(tick.wrench, built.simulation->dt());
    most = std::max(most, -tick.wrench[2]);
  }
  EXPECT_GT(most, 0.5) << "N: the splint is hardly felt";
}

TEST(ShippedScene, ClosesTheHumanPair) {
  const auto folder = data_dir();
  if (!std::filesystem::is_regular_file(folder / "human_mandible.stl") ||
      !std::filesystem::is_regular_file(folder / "human_maxilla.stl")) {
    IST_SKIP("the human pair is not in " << folder);
  }
  const ScopedVariable data("IST_DATA_DIR", folder.c_str());
  const Scene scene = shipped("human_pair");
  EXPECT_EQ(std::get<std::filesystem::path>(scene.fixed.front().source),
            folder / "human_maxilla.stl");
  EXPECT_EQ(std::get<std::filesystem::path>(scene.held.front().source),
            folder / "human_mandible.stl");
  EXPECT_FALSE(scene.fixed.front().voxel_size);
  EXPECT_EQ(scene.open.value(), Eigen::Vector3d(0, 0, -1));
  EXPECT_TRUE(scene.contact && scene.friction && scene.damping);
  EXPECT_EQ(effects(scene), 1u);
  const auto& plan = std::get<HandSettings>(scene.device).plan;
  EXPECT_TRUE(plan[1].pose.translation.isZero(0)) << "does not close fully";
  EXPECT_EQ(scene.seconds, plan.back().time);
}

}  // namespace
}  // namespace ist::test
