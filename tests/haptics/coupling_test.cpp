#include "ist/haptics/coupling.h"

#include <gtest/gtest.h>

namespace ist::test {
namespace {

constexpr CouplingSettings kSettings{1000, 0.5, 2, 0.001, 4, 0.1};

VirtualCoupling::Stretch stretched(double x, double turn) {
  VirtualCoupling::Stretch stretch{Vector6::Zero(), Vector6::Zero(), 1e-3};
  stretch.length << x, 0, 0, 0, 0, turn;
  return stretch;
}

TEST(VirtualCoupling, PullsTheToolTowardsTheDevice) {
  const VirtualCoupling coupling(kSettings);
  const Vector6 wrench = coupling.wrench(stretched(0.002, 0.01), Vector6::Zero());
  EXPECT_DOUBLE_EQ(wrench[0], 2.0);
  EXPECT_DOUBLE_EQ(wrench[5], 0.02);
  EXPECT_EQ(wrench[1], 0);
  EXPECT_EQ(wrench[3], 0);
}

TEST(VirtualCoupling, PullsNoHarderHoweverFarItIsStretched) {
  const VirtualCoupling coupling(kSettings);
  for (const double far : {0.004, 0.01, 1.0, 1e6}) {
    const Vector6 wrench = coupling.wrench(stretched(-far, far * 100), Vector6::Zero());
    EXPECT_DOUBLE_EQ(wrench[0], -4.0) << far;
    EXPECT_DOUBLE_EQ(wrench[5], 0.1) << far;
  }
}

TEST(VirtualCoupling, DampsHowFastItIsStretched) {
  const VirtualCoupling coupling(kSettings);
  VirtualCoupling::Stretch stretch = stretched(0, 0);
  stretch.device[1] = 1e-4;  // 0.1 m/s
  EXPECT_DOUBLE_EQ(coupling.wrench(stretch, Vector6::Zero())[1], 0.05);
  Vector6 along = stretch.device;  // the tool goes along: only the spring is left, stretched back
  EXPECT_DOUBLE_EQ(coupling.wrench(stretch, along)[1], -0.1);
}

TEST(VirtualCoupling, TellsHowItsWrenchChanges) {
  const VirtualCoupling coupling(kSettings);
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

}  // namespace
}  // namespace ist::test
