// A shell that fits into a shell: thousands of features are near at once.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <memory>
#include <set>

#include "haptics/wall/wall_case.h"
#include "ist/mesh/bounding_box.h"
#include "loop/haptics/wall/wall_pair.h"
#include "support/conformal.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

// The surfaces are near everywhere, over 17,000 mm². A facet's middle is 8 µm below its corners.
constexpr double kFitRadius = 36.8, kFitGap = 0.02;  // mm
constexpr int kFitLevel = 5;

const ConformalPair& fit() {
  static const ConformalPair made = shell_in_shell(kFitLevel, kFitRadius, kFitGap);
  return made;
}

double angle_of(const Placement& pose) { return Eigen::AngleAxisd(pose.rotation).angle(); }

// More pairs of triangles are near than the wall has room for, and more features than are listed:
// the nearest of each cell and octant of normals is there.
TEST(WallConformal, FeaturesOfAShellInAShellAreThinned) {
  const auto fixed = std::make_shared<WallBody>(build_tree(fit().fixed));
  const auto held = std::make_shared<WallBody>(build_tree(fit().moving));
  constexpr std::size_t kRoom = 512;
  WallPair pair(fixed, held, {.features = kRoom});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vector3d(0.004, 0.003, -0.002);
  constexpr double kMargin = 0.025;
  ASSERT_TRUE(pair.find(pose, kMargin, 0, {}).complete);
  Query query(fixed->tree, held->tree);
  const NearPairsResult near = query.near_pairs(pose, kMargin, {});
  EXPECT_GT(near.near_pairs, 100'000u);
  const double least = query.distance(pose, 0).distance.upper;
  // A part of the held body's diagonal.
  const double cell = bounding_box(fit().moving).diagonal().norm() / 64;
  for (const FeatureList::Which which : {FeatureList::Which::kMinima, FeatureList::Which::kAll}) {
    pair.list(which);
    EXPECT_LE(pair.features().size(), kRoom);
    EXPECT_GE(pair.features().size(), 100u);
    EXPECT_LE(pair.features().front().gap, least + 1e-9);
    if (which == FeatureList::Which::kMinima) continue;  // there is room for all
    std::set<std::array<long, 4>> places;
    for (const Feature& feature : pair.features()) {
      std::array<long, 4> place{};
      for (int i = 0; i < 3; ++i) {
        const auto axis = static_cast<std::size_t>(i);
        place[axis] = std::lround(std::floor(feature.moving_point[i] / cell));
        place[3] = 2 * place[3] + (feature.normal[i] > 0 ? 1 : 0);
      }
      EXPECT_TRUE(places.insert(place).second) << "another feature of this cell is nearer";
    }
  }
  // The proof asks all triangles.
  for (const double way : {0.003, 0.01, 0.02}) {
    Eigen::Isometry3d there = pose;
    there.translation().x() += way;
    EXPECT_EQ(pair.meets(there, 1.01 * way, {}), query.intersects(there).answer);
  }
}

// The device goes far to the side and turns. The tool rests at the shell, and turns with the
// device.
TEST(WallConformal, ToolIsPressedAndTurns) {
  WallCase wall(fit().fixed, fit().moving, at_mm(0, 0, 0), {.max_force = 5});
  wall.go(at_mm(2, 0, 0), 4);
  const Tick pressed = wall.hold(at_mm(2, 0, 0), 2);
  EXPECT_GT(pressed.wrench.head<3>().norm(), 1.9);
  EXPECT_FALSE(pressed.points.empty());
  EXPECT_LT(wall.tool().norm(), kFitGap);
  const Eigen::Matrix3d turn = turn_about({1, 0, 0}, 0.5);
  wall.go(at_mm(2, 0, 0, turn), 8);
  wall.hold(at_mm(2, 0, 0, turn), 4);
  EXPECT_GT(angle_of(wall.pose()), 0.9 * Eigen::AngleAxisd(turn).angle());
  EXPECT_EQ(wall.held(), 0);
}

// A budget ends each tick. The tool stays at its last free pose, and feels the coupling.
TEST(WallConformal, BudgetEndsTheTickAndTheToolHolds) {
  WallCase wall(fit().fixed, fit().moving, at_mm(0, 0, 0), {.max_force = 5});
  TickBudget few;
  few.contacts.tests = 20'000;
  for (int i = 1; i <= 20; ++i) {
    const Tick tick = wall.tick(at_mm(0.1 * i, 0, 0), few);
    EXPECT_TRUE(tick.held);
    EXPECT_EQ(tick.steps, 0);
    ASSERT_TRUE(tick.contacts);
    EXPECT_FALSE(tick.contacts->complete);
    EXPECT_LE(tick.contacts->sphere_tests, few.contacts.tests + 600) << "a call of a kernel more";
  }
  EXPECT_EQ(wall.tool().norm(), 0);
}

}  // namespace
}  // namespace ist::test
