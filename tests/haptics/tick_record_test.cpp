#include <gtest/gtest.h>

#include <limits>

#include "haptics/effects/effect_case.h"
#include "haptics/haptic_cases.h"
#include "ist/haptics/recording.h"
#include "support/effort.h"

namespace ist::test {
namespace {

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
