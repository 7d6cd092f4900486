#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "ist/query/query.h"
#include "ist/scene.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/random.h"

// Runs of a hand that does anything: the held body never intersects the fixed one.
namespace ist::test {
namespace {

constexpr double kRunUnit = 1e-3;
constexpr double kRunForce = 10, kRunTorque = 0.4;  // N, N m

// How a hand moves from tick to tick.
enum class Hand { kWanders, kJumps, kPushes };

struct RunBodies {
  const char* name;
  const char *fixed, *held;  // files of the data folder; null: the built-in jaws
  double open;               // along z, mm: the bodies are apart there
};

Scene scene_of(const RunBodies& run) {
  Scene scene;
  scene.unit = kRunUnit;
  const bool built_in = run.fixed == nullptr;
  if (built_in) {
    scene.fixed.front().source = BuiltInShape{.kind = BuiltInShape::Kind::kUpperJaw};
    scene.held.front().source = BuiltInShape{.kind = BuiltInShape::Kind::kLowerJaw};
  } else {
    scene.fixed.front().source = data_dir() / run.fixed;
    scene.held.front().source = data_dir() / run.held;
  }
  scene.held.front().translation = {0, 0, run.open};
  scene.device = NullSettings{{.damping = 4, .angular_damping = 4e-3}};
  scene.coupling.max_force = kRunForce;
  scene.coupling.max_torque = kRunTorque;
  scene.safety = {kRunForce, kRunTorque, 1e9, 1e9, 0};
  scene.contact = ContactSettings{};
  return scene;
}

class WallRun {
 public:
  explicit WallRun(const RunBodies& run)
      : built_(build_scene(scene_of(run))),
        judge_(*built_.trees[0].contact, *built_.trees[1].contact),
        home_(built_.simulation->tool_pose()),
        closed_(-run.open) {}

  // Makes ticks, and counts those that were held or halved.
  void run(Hand hand, std::uint64_t ticks, Random& random) {
    Placement device = home_;
    Eigen::Vector3d speed = Eigen::Vector3d::Zero(), at = Eigen::Vector3d::Zero();
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
    Placement before = built_.simulation->tool_pose();
    for (std::uint64_t i = 0; i < ticks; ++i) {
      switch (hand) {
        case Hand::kWanders:  // up to some 100 mm/s about the closed pose
          speed += random.point(-0.02, 0.02) - 0.002 * (at - Eigen::Vector3d(0, 0, closed_));
          speed *= 0.97;
          at += speed;
          turn = 0.98 * turn + random.point(-2e-3, 2e-3);
          break;
        case Hand::kJumps:
          if (i % 64 == 0) {
            at = random.point(-20, 20) + Eigen::Vector3d(0, 0, closed_);
            turn = random.point(-0.3, 0.3);
          }
          break;
        case Hand::kPushes:  // far behind the contact, another way each quarter of a second
          if (i % 256 == 0) {
            at = random.point(-4, 4) + Eigen::Vector3d(0, 0, closed_ + 8);
            turn = random.point(-0.1, 0.1);
          }
          break;
      }
      Vector6 motion;
      motion << kRunUnit * at, turn;
      device = home_.moved(motion);
      const Tick tick = built_.simulation->tick(device);
      ASSERT_FALSE(tick.fault);
      ASSERT_EQ(judge_.intersects(pose()).answer, Answer::kNo) << "tick " << i;
      ASSERT_LE(tick.wrench.head<3>().norm(), kRunForce * (1 + 1e-12));
      held_ += tick.held || tick.halved ? 1U : 0U;
      pressed_ += tick.points.empty() ? 0U : 1U;
      way_ += (tick.tool.translation - before.translation).norm();
      before = tick.tool;
      ++ticks_;
    }
  }

  // A tool that stands still, or touches nothing, shows nothing.
  void expect_life() const {
    EXPECT_LE(static_cast<double>(held_), 0.001 * static_cast<double>(ticks_) + 1);
    EXPECT_GT(static_cast<double>(pressed_), 0.1 * static_cast<double>(ticks_));
    EXPECT_GT(way_, 1e-6 * static_cast<double>(ticks_));
  }

 private:
  // Maps held mesh coordinates to fixed mesh coordinates.
  [[nodiscard]] Eigen::Isometry3d pose() const {
    const Eigen::Isometry3d fixed = built_.simulation->body_pose(0).isometry();
    Eigen::Isometry3d pose = fixed.inverse() * built_.simulation->body_pose(1).isometry();
    pose.translation() /= kRunUnit;
    return pose;
  }

  BuiltScene built_;
  Query judge_;
  Placement home_;
  double closed_;  // along z from the start, mm
  std::uint64_t ticks_ = 0, held_ = 0, pressed_ = 0;
  double way_ = 0;
};

class WallRuns : public testing::TestWithParam<RunBodies> {};

TEST_P(WallRuns, NeverIntersect) {
  const RunBodies& run = GetParam();
  if (run.fixed != nullptr && !std::filesystem::exists(data_dir() / run.fixed)) {
    IST_SKIP(run.fixed << " is not in " << data_dir());
  }
  WallRun wall(run);
  Random random(91);
  const std::uint64_t ticks = samples<std::uint64_t>(1'000);
  for (const Hand hand : {Hand::kWanders, Hand::kPushes, Hand::kJumps, Hand::kPushes}) {
    wall.run(hand, ticks, random);
    if (HasFatalFailure()) return;
  }
  wall.expect_life();
}

INSTANTIATE_TEST_SUITE_P(Bodies, WallRuns,
                         testing::Values(RunBodies{"Jaws", nullptr, nullptr, -5},
                                         RunBodies{"HumanPair", "human_maxilla.stl",
                                                   "human_mandible.stl", -4},
                                         RunBodies{"CraniumAndMandible", "spl_cranium_face.stl",
                                                   "spl_mandible.stl", -7}),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace ist::test
