#include "ist/haptics/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptics/effects/effect_case.h"
#include "haptics/haptic_cases.h"
#include "ist/haptics/recording.h"
#include "support/effort.h"

namespace ist::test {
namespace {

// The ball is pressed on the box along -z, to 1 mm below the first contact.
class Pressing : public ::testing::Test {
 protected:
  Pressing() : bodies_(ball_over_box()), simulation_(bodies_.simulation()) {}

  Tick press(double z, const TickBudget& budget = {}) {
    Placement device = bodies_.at(z);
    return simulation_.tick(device, budget);
  }
  // Ticks until the hand is at z, 10 µm each, and then some to come to rest.
  Tick close_to(double z, int rest = 600) {
    for (double at = 1e-3; at > z; at -= 1e-5) press(at);
    Tick tick{};
    for (int i = 0; i < rest; ++i) tick = press(z);
    return tick;
  }

  HapticBodies bodies_;
  Simulation simulation_;
};

TEST_F(Pressing, NothingIsFeltWhereNothingIsTouched) {
  const Tick tick = close_to(9e-4);
  EXPECT_EQ(tick.contacts->leaf_pairs, 0u);
  EXPECT_LT(tick.wrench.norm(), 1e-9);
  EXPECT_LT((tick.tool.translation - tick.device.translation).norm(), 1e-12);
}

// The tool stays out, and the hand feels the spring of its coupling, which balances the contact.
TEST_F(Pressing, TheToolStaysOutsideAndTheHandFeelsIt) {
  const Tick tick = close_to(-2e-3);
  EXPECT_GT(tick.leaf_pairs, 1);
  EXPECT_GT(tick.tool.translation.z() - bodies_.touching(), -bodies_.voxel());
  const double stretch = tick.tool.translation.z() - tick.device.translation.z();
  const double felt = std::min(kHapticCoupling.stiffness * stretch, kHapticCoupling.max_force);
  EXPECT_NEAR(tick.wrench[2], felt, 1e-6);
  EXPECT_GT(tick.wrench[2], 1);
  EXPECT_LT(tick.wrench.head<2>().norm(), 0.05 * tick.wrench[2]);
}

// At rest the force does not tremble.
TEST_F(Pressing, RestsInTheContact) {
  close_to(-2e-3);
  double least = 1e9, most = 0;
  for (int i = 0; i < 500; ++i) {
    const double force = press(-2e-3).wrench.norm();
    least = std::min(least, force);
    most = std::max(most, force);
  }
  EXPECT_LT(most - least, 0.01 * most);
}

// A hand of any force and speed: the tool moves at most a voxel a tick, so the box stops it.
TEST_F(Pressing, DoesNotTunnel) {
  press(1e-3);
  Eigen::Vector3d before = press(1e-3).tool.translation;
  for (int i = 0; i < 3000; ++i) {
    const Tick tick = press(-5e-2);
    EXPECT_LE((tick.tool.translation - before).norm(), bodies_.voxel() * (1 + 1e-9));
    before = tick.tool.translation;
  }
  EXPECT_GT(before.z() - bodies_.touching(), -bodies_.voxel());
}

// Lack of time never lowers resistance. The tool stays at the pose of the last complete answer. The
// hand goes on and feels at least the same force.
TEST_F(Pressing, KeepsWhatItKnewWhereAnAnswerIsNotComplete) {
  const Tick before = close_to(-1e-3);
  TickBudget none;
  none.contacts.tests = 3;
  double force = before.wrench[2];
  for (int i = 1; i <= 100; ++i) {
    const Tick tick = press(-1e-3 - 5e-6 * i, none);
    EXPECT_TRUE(tick.held);
    EXPECT_FALSE(tick.contacts->complete);
    EXPECT_GE(tick.tool.translation.z(), before.tool.translation.z() - 1e-9);
    EXPECT_GE(tick.wrench[2], force - 1e-9);
    EXPECT_EQ(tick.leaf_pairs, press(-1e-3 - 5e-6 * i, none).leaf_pairs);
    force = tick.wrench[2];
  }
  // And it goes on when there is time again.
  EXPECT_FALSE(press(-1e-3).held);
}

// A step that led to where there was no time is tried again half as long, and half again.
TEST_F(Pressing, DaresHalfAsLongAStepWhereThereWasNoTime) {
  TickBudget none;
  none.contacts.tests = 0;
  press(1e-3);
  double before = press(1e-3).tool.translation.z();
  for (double part = 1; part > 0.1; part *= 0.5) {
    const double after = press(-5e-2).tool.translation.z();
    EXPECT_LE(before - after, part * bodies_.voxel() * (1 + 1e-9));
    EXPECT_GE(before - after, 0.9 * part * bodies_.voxel());
    const Tick held = press(-5e-2, none);
    EXPECT_TRUE(held.held);
    EXPECT_EQ(held.tool.translation.z(), before);
  }
  press(-5e-2);  // what leads to a complete answer may be longer again
  before = press(-5e-2).tool.translation.z();
  EXPECT_GT(before - press(-5e-2).tool.translation.z(), 0.2 * bodies_.voxel());
}

// However long there was no time, the tool goes on when there is.
TEST_F(Pressing, GoesOnAfterAnyNumberOfAnswersThatWereNotComplete) {
  TickBudget none;
  none.contacts.tests = 0;
  for (int i = 0; i < 3000; ++i) EXPECT_TRUE(press(8e-4, none).held);
  Tick tick{};
  for (int i = 0; i < 100; ++i) tick = press(8e-4);
  EXPECT_NEAR(tick.tool.translation.z(), bodies_.at(8e-4).translation.z(), 1e-9);
}

// Adds up the tool's way along z, without the way back from a held tick.
class AxisDirection final : public Effect {
 public:
  AxisDirection(double& sum, int& ticks) : sum_(sum), ticks_(ticks) {}
  [[nodiscard]] std::string_view name() const noexcept override { return "way"; }
  [[nodiscard]] EffectNeeds needs() const noexcept override { return {}; }
  void respond(const EffectInput&, const Vector6&, Response&) const noexcept override {}
  void advance(const EffectInput&, const Vector6& motion) noexcept override {
    sum_ += motion[2];
    ++ticks_;
  }

 private:
  double& sum_;
  int& ticks_;
};

TEST(HeldTicks, EffectsGoWithTheToolAndNotAheadOfIt) {
  const HapticBodies bodies = ball_over_box();
  double way = 0;
  int told = 0, held = 0;
  Simulation simulation = bodies.simulation(std::make_unique<AxisDirection>(way, told));
  TickBudget none;
  none.contacts.tests = 0;
  Tick tick{};
  for (int i = 0; i < 400; ++i) {
    tick = simulation.tick(bodies.at(1e-3 - 5e-6 * i), i % 5 == 2 ? none : TickBudget());
    held += tick.held ? 1 : 0;
  }
  EXPECT_EQ(held, 80);
  tick = simulation.tick(bodies.at(-1e-3), none);  // back to where all was known
  EXPECT_NEAR(way, tick.tool.translation.z() - bodies.at(1e-3).translation.z(), 1e-12);
  EXPECT_EQ(told, 400 - 2 * 80 - 1);
}

TEST_F(Pressing, AfterAFaultNothingIsFeltAndThenLittleByLittle) {
  const double before = close_to(-2e-3).wrench.norm();
  const Tick fault = simulation_.tick(std::nullopt, {});
  EXPECT_TRUE(fault.fault);
  EXPECT_EQ(fault.wrench, Vector6(Vector6::Zero()));
  double last = 0;
  const int ticks = static_cast<int>(kHapticSafety.soft_start / simulation_.dt());
  for (int i = 0; i < ticks; ++i) {
    const Tick tick = press(-2e-3);
    EXPECT_FALSE(tick.fault);
    EXPECT_LE(tick.wrench.head<3>().norm(), kHapticSafety.max_force * (i + 1) / ticks * (1 + 1e-9));
    EXPECT_GE(tick.wrench.norm(), last - 1e-9);
    last = tick.wrench.norm();
  }
  EXPECT_NEAR(last, before, 0.05 * before);
}

TEST_F(Pressing, ADevicePoseThatIsNoneIsAFault) {
  close_to(-1e-3, 10);
  for (const double none : {std::nan(""), HUGE_VAL}) {
    Placement device = bodies_.at(-1e-3);
    device.translation[1] = none;
    const Tick tick = simulation_.tick(device, {});
    EXPECT_TRUE(tick.fault);
    EXPECT_EQ(tick.wrench, Vector6(Vector6::Zero()));
    EXPECT_TRUE(tick.tool.translation.allFinite());
  }
  EXPECT_FALSE(press(-1e-3).fault);
}

// A tick depends on the device, and on the completeness of its queries. It depends neither on their
// tests nor on caches of earlier ticks.
TEST_F(Pressing, WhetherItWasStoppedGivesTheSameBits) {
  Simulation again = bodies_.simulation();
  for (int i = 0; i < 400; ++i) {
    const double z = 1e-3 - 1e-5 * i;
    TickBudget budget;
    if (i % 7 == 3) budget.contacts.tests = static_cast<std::uint64_t>(i);
    const Tick first = press(z, budget);
    TickBudget stopped;
    if (!first.contacts->complete) stopped.contacts.tests = 0;
    const Tick second = again.tick(bodies_.at(z), stopped);
    EXPECT_EQ(first.tool.translation, second.tool.translation);
    EXPECT_EQ(first.tool.rotation, second.tool.rotation);
    EXPECT_EQ(first.wrench, second.wrench);
    EXPECT_EQ(first.held, second.held);
    if (first.contacts->complete) {
      EXPECT_EQ(first.contacts->leaf_pairs, second.contacts->leaf_pairs);
    }
  }
}

TEST(TickRecord, HoldsATickInPlainNumbers) {
  const HapticBodies bodies = ball_over_box();
  Simulation simulation = bodies.simulation();
  Tick tick{};
  for (int i = 0; i < 600; ++i) tick = simulation.tick(bodies.at(1e-3 - 5e-6 * i), {});
  ASSERT_GT(tick.contacts->leaf_pairs, 0u);
  const TickRecord record = record_of(7, 1e-3, tick, true);
  EXPECT_EQ(record.tick, 7u);
  EXPECT_TRUE(record.device_known);
  EXPECT_FALSE(record.fault || record.held || record.proximity);
  EXPECT_EQ(record.contacts->sphere_tests, tick.contacts->sphere_tests);
  EXPECT_EQ(record.leaf_pairs, tick.leaf_pairs);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(record.wrench[static_cast<std::size_t>(i)], tick.wrench[i]);
  }
  EXPECT_EQ(record.late_ns + record.execution_ns + record.cpu_ns, 0);
  EXPECT_FALSE(record_of(8, 1e-3, simulation.tick(std::nullopt, {}), false).device_known);
}

TEST(TickRecord, PosesComeBackBitForBit) {
  Random random(21);
  Placement placement;
  for (int i = 0; i < samples(500); ++i) {
    placement = placement.moved(six(random.point(-0.01, 0.01), random.point(-1, 1)));
    const TickRecord::Pose numbers = to_numbers(placement);
    EXPECT_EQ(numbers[1], placement.translation.y());
    EXPECT_EQ(numbers[3 + 1], placement.rotation(1, 0));  // column by column
    EXPECT_EQ(numbers[3 + 6], placement.rotation(0, 2));
    const std::optional<Placement> back = to_placement(numbers);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->translation, placement.translation);
    EXPECT_EQ(back->rotation, placement.rotation);
  }
}

TEST(TickRecord, NumbersThatAreNoRigidMotionAreRefused) {
  TickRecord::Pose numbers = to_numbers(Placement());
  for (const double none : {0.0, 2.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity()}) {
    TickRecord::Pose bad = numbers;
    bad[3] = none;
    EXPECT_FALSE(to_placement(bad)) << none;
  }
  numbers[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(to_placement(numbers));
}

// A recording is made again tick by tick, those that were stopped and those without a device too.
TEST(TickRecord, ReplayMakesTheSameTicks) {
  const HapticBodies bodies = ball_over_box();
  Simulation first = bodies.simulation(), again = bodies.simulation();
  int held = 0, faults = 0;
  for (std::uint64_t i = 0; i < 800; ++i) {
    std::optional<Placement> device = bodies.at(1e-3 - 4e-6 * static_cast<double>(i));
    if (i % 97 == 50) device.reset();
    TickBudget budget;
    if (i % 11 == 3) budget.contacts.tests = 5 * i;
    const TickRecord made =
        record_of(i, first.dt(), first.tick(device, budget), device.has_value());
    TickBudget stopped;
    if (!made.contacts->complete) stopped.contacts.tests = 0;
    const TickRecord repeated = replay({i, device, stopped}, again);
    EXPECT_EQ(repeated.tick, i);
    EXPECT_EQ(repeated.device, made.device);
    EXPECT_EQ(repeated.tool, made.tool);
    EXPECT_EQ(repeated.wrench, made.wrench);
    EXPECT_EQ(repeated.held, made.held);
    EXPECT_EQ(repeated.fault, made.fault);
    EXPECT_EQ(repeated.device_known, made.device_known);
    EXPECT_EQ(repeated.leaf_pairs, made.leaf_pairs);
    EXPECT_EQ(repeated.contacts->complete, made.contacts->complete);
    if (made.contacts->complete) {
      EXPECT_EQ(repeated.contacts->leaf_pairs, made.contacts->leaf_pairs);
    }
    held += made.held;
    faults += made.fault;
  }
  EXPECT_GT(held, 20);
  EXPECT_EQ(faults, 8);
}

}  // namespace
}  // namespace ist::test
