// A shell that fits into a shell: thousands of features are near at once.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <memory>

#include "haptics/wall/wall_case.h"
#include "loop/haptics/wall/wall_pair.h"
#include "support/conformal.h"
#include "support/effort.h"

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

// More pairs of triangles are near than the wall has room for, and more features than are listed.
TEST(WallConformal, FeaturesOfAShellInAShellAreThinned) {
  const auto fixed = std::make_shared<WallBody>(build_tree(fit().fixed));
  const auto held = std::make_shared<WallBody>(build_tree(fit().moving));
  constexpr std::size_t kRoom = 512;
  WallPair pair(fixed, held, {.features = kRoom});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = {0.004, 0.003, -0.002};
  constexpr double kMargin = 0.025;
  ASSERT_TRUE(pair.find(pose, kMargin, 0, {}).complete);
  for (const FeatureList::Which which : {FeatureList::Which::kMinima, FeatureList::Which::kAll}) {
    pair.list(which);
    EXPECT_EQ(pair.features().size(), kRoom);
    // They lie on all sides.
    Vector3d middle = Vector3d::Zero();
    for (const Feature& feature : pair.features()) middle += feature.normal;
    EXPECT_LT(middle.norm(), 0.5 * kRoom);
  }
  // The proof asks all triangles.
  Query query(fixed->tree, held->tree);
  for (const double way : {0.003, 0.01, 0.02}) {
    Eigen::Isometry3d there = pose;
    there.translation().x() += way;
    EXPECT_EQ(pair.meets(there, 1.01 * way, {}), query.intersects(there).answer);
  }
}

// The device goes far to the side and turns. The tool rests at the shell, and turns with the
// device.
TEST(WallConformal, ToolIsPressedAndTurns) {
  IST_SLOW();
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
