// The energy that the constraint gives to a hand with mass, against docs/guarantees.md, "The wall
// of the hand".
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "haptics/wall_press.h"
#include "loop/haptics/stability_border.h"
#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

constexpr double kInside = 0.8;  // the part of the border that clamp_coupling() leaves
constexpr double kBeyond = 2;    // the part at which a wall is surely active

struct NamedWall {
  const char* name;
  PressedWall wall;
};

std::vector<NamedWall> walls() {
  std::vector<NamedWall> walls;
  walls.push_back({"box on box", slab_wall(Stop::kConstraint)});
  walls.push_back({"ball on plate", tip_wall(Stop::kConstraint)});
  walls.push_back({"edge on edge", edge_wall()});
  walls.push_back({"turn against two stops", stop_wall(Stop::kConstraint)});
  return walls;
}

// A press with a part of the border's stiffness, at a rate, with a delay of whole periods.
PressSettings at(const PressedWall& wall, double part, double rate, int delay, bool has_encoders) {
  const double damping = wall.turns ? 2e-3 : 2;
  PressSettings settings{.rate = rate, .delay = delay / rate, .damping = damping};
  settings.stiffness = part * largest_stiffness(damping, 0, 1 / rate, settings.delay);
  if (has_encoders) settings.resolution = wall.turns ? 2e-5 : 2e-6;
  return settings;
}

// Without and with encoders, each rate with no delay, with a period and with four.
std::vector<PressSettings> points(const PressedWall& wall, double part,
                                  const std::vector<double>& rates = {500, 1000, 4000}) {
  std::vector<PressSettings> points;
  for (const double rate : rates) {
    for (const int delay : {0, 1, 4}) {
      for (const bool has_encoders : {false, true}) {
        points.push_back(at(wall, part, rate, delay, has_encoders));
      }
    }
  }
  return points;
}

std::string told(const NamedWall& wall, const PressSettings& settings) {
  return std::string(wall.name) + ", " + std::to_string(settings.rate) + " Hz, delay " +
         std::to_string(settings.delay) + ", K " + std::to_string(settings.stiffness) + ", q " +
         std::to_string(settings.resolution) + ", friction " + std::to_string(settings.friction);
}

void expect_accounted(const PressResult& result) {
  EXPECT_GT(result.touching, 100U) << "nothing was pressed";
  EXPECT_LE(result.energy.work, result.energy.leaks());
  // Gaps that are asked back are of second order.
  EXPECT_LT(result.energy.asked_back, 0.05 * result.energy.leaks());
}

// The device's damping takes more than a sampled spring leaks.
void expect_passive(const PressResult& result) {
  EXPECT_LE(result.returned, result.allowance);
  EXPECT_LT(result.growth(), 1);
}

// Poses at random from where the bodies part to where the coupling is pulled by millimetres.
std::vector<Vector6> poses_at(const PressedWall& wall, Random& random, int count) {
  std::vector<Vector6> poses;
  for (int i = 0; i < count; ++i) {
    Vector6 pose;
    pose << random.point(-2e-3, 2e-3), random.point(-0.2, 0.2);
    pose += random.uniform(0, 0.8) * wall.reach * wall.way;
    poses.push_back(pose);
  }
  return poses;
}

TEST(WallEnergy, OfAPressIsNoMoreThanTheLeaks) {
  for (const NamedWall& wall : walls()) {
    for (const PressSettings& settings : points(wall.wall, kInside)) {
      SCOPED_TRACE(told(wall, settings));
      const PressResult result = press(wall.wall, settings);
      expect_accounted(result);
      expect_passive(result);
    }
  }
}

TEST(WallEnergy, OfAPressWithFrictionAndDampingIsNoMoreThanTheLeaks) {
  for (const NamedWall& wall : walls()) {
    for (PressSettings settings : points(wall.wall, kInside, {500, 1000})) {
      settings.friction = 0.3;
      settings.contact_damping = 10;
      SCOPED_TRACE(told(wall, settings));
      const PressResult result = press(wall.wall, settings);
      expect_accounted(result);
      expect_passive(result);
    }
  }
}

TEST(WallEnergy, OfAPressWithADamperInTheCouplingIsPassive) {
  IST_SLOW();
  for (const NamedWall& wall : walls()) {
    for (PressSettings settings : points(wall.wall, kInside, {500, 1000})) {
      settings.coupling_damping = 0.5 * settings.damping;
      settings.stiffness *= 0.5;  // largest_stiffness() falls in proportion to b - |B|
      SCOPED_TRACE(told(wall, settings));
      expect_passive(press(wall.wall, settings));
    }
  }
}

// A press along one normal leaks as much as the sum says, to a few percent: the sum is no wide
// bound.
TEST(WallEnergy, OfAPlainPressIsTheLeaks) {
  const PressedWall wall = slab_wall(Stop::kConstraint);
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    const PressResult result = press(wall, at(wall, kInside, rate, 0, false));
    EXPECT_GT(result.energy.work, 0.85 * result.energy.leaks()) << rate;
  }
}

TEST(WallEnergy, OfAClosedRandomPathIsNoMoreThanTheLeaks) {
  Random random(5);
  for (const NamedWall& wall : walls()) {
    for (int i = 0; i < samples(6); ++i) {
      PressSettings settings = at(wall.wall, kInside, i < 3 ? 500 : 1000, i % 4, i % 2 == 1);
      if (i % 3 > 0) settings.friction = 0.3;
      if (i % 3 > 1) settings.contact_damping = 10;
      SCOPED_TRACE(told(wall, settings));
      const PressResult result = wander(wall.wall, settings, poses_at(wall.wall, random, 12), 0.15);
      expect_accounted(result);
      EXPECT_LE(result.returned, result.allowance);
    }
  }
}

TEST(WallEnergy, BelowTheBorderTheHandComesToRest) {
  for (const NamedWall& wall : walls()) {
    for (const int delay : {0, 1, 4}) {
      PressSettings settings = at(wall.wall, kInside, 1000, delay, false);
      settings.hold = 4;
      SCOPED_TRACE(told(wall, settings));
      const PressResult result = press(wall.wall, settings);
      EXPECT_GT(result.early, 0);
      EXPECT_LT(result.late, 0.01 * result.early);
    }
  }
}

// The criterion of passivity can fail: the account of the leaks still holds.
TEST(WallEnergy, BeyondTheBorderAPressIsActive) {
  for (const NamedWall& wall : walls()) {
    // Other walls turn the tool, and the damping of the turn pays.
    if (wall.wall.way[2] == 0 || std::string(wall.name) == "edge on edge") continue;
    for (const PressSettings& settings : points(wall.wall, kBeyond, {1000})) {
      SCOPED_TRACE(told(wall, settings));
      const PressResult result = press(wall.wall, settings);
      EXPECT_GT(result.returned, result.allowance);
      EXPECT_LE(result.energy.work, result.energy.leaks());
    }
  }
}

// A ball that is pressed beside the end of a slab slips off it, and is far from the device then.
TEST(WallEnergy, TheForceOfABallThatSlipsOffFallsAtABoundedRate) {
  constexpr double kStiffness = 1000;
  const PressedWall wall = tip_wall(Stop::kConstraint);
  Simulation simulation = press_simulation(wall, {.stiffness = kStiffness});
  Placement device = press_start(wall), last = device;
  Vector6 felt = Vector6::Zero();
  double most_felt = 0;
  for (int i = 0; i < 1000; ++i) {
    device = press_start(wall);
    device.translation +=
        Eigen::Vector3d(i < 300 ? 4e-3 : 10e-3, 0, -4e-3 * std::min(i / 200.0, 1.0));
    const Tick tick = simulation.tick(device);
    const double change = (tick.wrench - felt).head<3>().norm();
    const double way = (device.translation - last.translation).norm();
    EXPECT_LE(change, kStiffness * (way + kPressSteps * kPressTrust) * (1 + 1e-9)) << i;
    most_felt = std::max(most_felt, tick.wrench.head<3>().norm());
    felt = tick.wrench;
    last = device;
  }
  EXPECT_GT(most_felt, 2);
  EXPECT_LT(felt.norm(), 1e-9) << "it has reached the device";
}

// The constraint is rigid, so that the border is the computed one.
TEST(WallEnergy, TheBorderIsTheComputedOne) {
  const PressedWall wall = slab_wall(Stop::kConstraint);
  for (const int delay : {0, 1}) {
    const PressSettings settings = at(wall, 1, 1000, delay, true);
    const double measured = measured_border(wall, settings, settings.stiffness);
    EXPECT_GT(measured, 0.95 * settings.stiffness) << delay;
    EXPECT_LT(measured, 1.25 * settings.stiffness) << delay;
  }
}

}  // namespace
}  // namespace ist::test
