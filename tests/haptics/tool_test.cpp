#include "loop/haptics/tool.h"

#include <gtest/gtest.h>

#include <cmath>

#include "loop/haptics/coupling.h"
#include "loop/haptics/effects/springs_effect.h"

namespace ist::test {
namespace {

constexpr CouplingSettings kToolCoupling{1000, 0.5, 2, 0.001, 4, 0.1};

VirtualCoupling::Stretch stretched(double x, double turn) {
  VirtualCoupling::Stretch stretch{Vector6::Zero(), Vector6::Zero(), 1e-3};
  stretch.length << x, 0, 0, 0, 0, turn;
  return stretch;
}

TEST(VirtualCoupling, PullsTheToolTowardsTheDevice) {
  const VirtualCoupling coupling(kToolCoupling);
  const Vector6 wrench = coupling.wrench(stretched(0.002, 0.01), Vector6::Zero());
  EXPECT_DOUBLE_EQ(wrench[0], 2.0);
  EXPECT_DOUBLE_EQ(wrench[5], 0.02);
  EXPECT_EQ(wrench[1], 0);
  EXPECT_EQ(wrench[3], 0);
}

TEST(VirtualCoupling, PullsNoHarderHoweverFarItIsStretched) {
  const VirtualCoupling coupling(kToolCoupling);
  for (const double far : {0.004, 0.01, 1.0, 1e6}) {
    const Vector6 wrench = coupling.wrench(stretched(-far, far * 100), Vector6::Zero());
    EXPECT_DOUBLE_EQ(wrench[0], -4.0) << far;
    EXPECT_DOUBLE_EQ(wrench[5], 0.1) << far;
  }
}

TEST(VirtualCoupling, DampsHowFastItIsStretched) {
  const VirtualCoupling coupling(kToolCoupling);
  VirtualCoupling::Stretch stretch = stretched(0, 0);
  stretch.device[1] = 1e-4;  // 0.1 m/s
  EXPECT_DOUBLE_EQ(coupling.wrench(stretch, Vector6::Zero())[1], 0.05);
  Vector6 along = stretch.device;  // the tool goes along: only the spring is left, stretched back
  EXPECT_DOUBLE_EQ(coupling.wrench(stretch, along)[1], -0.1);
}

TEST(VirtualCoupling, TellsHowItsWrenchChanges) {
  const VirtualCoupling coupling(kToolCoupling);
  const VirtualCoupling::Stretch stretch = stretched(0.001, 0.02);
  Response response;
  coupling.respond(stretch, Vector6::Zero(), response);
  EXPECT_EQ(response.wrench, coupling.wrench(stretch, Vector6::Zero()));
  for (int i = 0; i < 6; ++i) {
    Vector6 step = Vector6::Zero();
    step[i] = 1e-7;
    const Vector6 change =
        (coupling.wrench(stretch, -step) - coupling.wrench(stretch, step)) / 2e-7;
    EXPECT_NEAR((change - response.stiffness.col(i)).norm(), 0, 1e-5) << i;
  }
}

constexpr CouplingSettings kSpring{1000, 0, 2, 0, 5, 0.2};
constexpr double kToolDt = 1e-3, kContact = 3000;

// A tool that touches one plane z = const, from above, to a depth in metres.
struct Bench {
  Placement at;
  ToolContacts contacts, proximity;
  VirtualCoupling coupling{kSpring};
  VirtualCoupling::Stretch stretch{Vector6::Zero(), Vector6::Zero(), kToolDt};
  TimedEffects effects;

  explicit Bench(double depth) {
    contacts.add({Eigen::Vector3d(0, 0, -0.01), Eigen::Vector3d::UnitZ(), depth, 1});
    contacts.spring[2] = depth;
    contacts.count = 1;
    std::vector<std::unique_ptr<Effect>> contact;
    contact.push_back(std::make_unique<SpringsEffect>(SpringsSettings{.stiffness = kContact}));
    effects = TimedEffects(std::move(contact));
  }
  std::optional<Vector6> move(const Tool& tool, double part = 1) {
    return tool.motion({at, contacts, proximity, kToolDt}, effects, coupling, stretch, part);
  }
};

TEST(Tool, FollowsTheDeviceWhereNothingIsTouched) {
  Bench bench(0);
  bench.effects = TimedEffects();
  bench.stretch.length << 1e-3, -2e-3, 3e-3, 0.01, 0.02, -0.03;
  const auto motion = bench.move(Tool(0, Tool::kNoLimit));
  ASSERT_TRUE(motion);
  EXPECT_NEAR((*motion - bench.stretch.length).norm(), 0, 1e-15);
}

// Two springs in a row. The tool stops at their balance, because the contact's stiffness is
// implicit.
TEST(Tool, StopsWhereCouplingAndContactAreInBalance) {
  Bench bench(1e-4);
  bench.stretch.length[2] = -1e-3;
  const auto motion = bench.move(Tool(0, Tool::kNoLimit));
  ASSERT_TRUE(motion);
  // 1000 (-1e-3 - z) + 3000 (1e-4 - lead z) = 0
  EXPECT_NEAR((*motion)[2], (-1 + 0.3) / (1000 + SpringsEffect::kLead * 3000), 1e-12);
  EXPECT_NEAR(motion->head<2>().norm() + motion->tail<3>().norm(), 0, 1e-15);
}

// The contact's spring ends when the surfaces part, so it does not pull the tool back.
TEST(Tool, IsNotHeldBackWhereItLeaves) {
  Bench bench(1e-4);
  bench.stretch.length[2] = 5e-4;
  const auto motion = bench.move(Tool(0, Tool::kNoLimit));
  ASSERT_TRUE(motion);
  EXPECT_NEAR((*motion)[2], 5e-4, 1e-12);
}

TEST(Tool, GoesNoFartherThanItsLongestStep) {
  const Tool tool(0.05, 2e-4);
  Bench bench(0);
  for (const double far : {1e-3, 1.0, 1e9}) {
    bench.stretch.length << far, far, -far, 0.1, 0, 0.2;
    const auto motion = bench.move(tool);
    ASSERT_TRUE(motion);
    EXPECT_LE(tool.way(*motion), 2e-4 * (1 + 1e-12));
    EXPECT_GE(tool.way(*motion), 2e-4 * (1 - 1e-12));
    const auto half = bench.move(tool, 0.5);
    ASSERT_TRUE(half);
    EXPECT_LE(tool.way(*half), 1e-4 * (1 + 1e-12));
  }
}

// No point of a body moves farther than the way says.
TEST(Tool, KnowsHowFarItsSurfaceGoes) {
  const Tool tool(0.05, 1);
  Vector6 motion;
  motion << 1e-4, -2e-4, 3e-4, 0.01, -0.02, 0.005;
  const Placement after = Placement().moved(motion);
  for (int i = 0; i < 1000; ++i) {
    const double z = -1 + 2 * (i + 0.5) / 1000, r = std::sqrt(1 - z * z), a = 2.4 * i;
    const Eigen::Vector3d point = 0.05 * Eigen::Vector3d(r * std::cos(a), r * std::sin(a), z);
    const Eigen::Vector3d to = after.rotation * point + after.translation;
    EXPECT_LE((to - point).norm(), tool.way(motion));
  }
}

TEST(Tool, HasNoMotionWhereNumbersAreNone) {
  const Tool tool(0.05, 2e-4);
  for (const double none : {std::nan(""), HUGE_VAL}) {
    Bench bench(1e-4);
    bench.stretch.length[1] = none;
    EXPECT_FALSE(bench.move(tool));
  }
}

}  // namespace
}  // namespace ist::test
