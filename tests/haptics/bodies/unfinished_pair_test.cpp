// A tick in which one pair of bodies was not finished, while all others were.

#include <gtest/gtest.h>

#include "haptics/bodies/body_cases.h"
#include "ist/haptics/simulation.h"

namespace ist::test {
namespace {

bool is_same_place(const Placement& a, const Placement& b) {
  return a.rotation == b.rotation && a.translation == b.translation;
}

// The tool is pressed on the floor, and far from the walls and from the loose ball. A few tests are
// enough for these, and not for the floor, which is the first pair.
TEST(UnfinishedPair, HoldsTheTool) {
  const BuiltScene built = build_scene(five_bodies());
  Simulation& simulation = *built.simulation;
  const Placement start = simulation.tool_pose();
  Placement last = start;
  Tick tick{};
  const auto go_down = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      last = simulation.tool_pose();
      tick = simulation.tick(moved_by(start, {0, 0, -3 * std::min(1.0, i / 400.0)}));
      ASSERT_FALSE(tick.held);
    }
  };
  go_down(400);
  ASSERT_GT(tick.leaf_pairs, 1);
  ASSERT_GT(tick.wrench[2], 0.5);
  ASSERT_FALSE(is_same_place(tick.tool, last)) << "it moves";
  TickBudget few;
  few.contacts.tests = 20;
  for (int i = 0; i < 200; ++i) {
    const Tick held = simulation.tick(moved_by(start, {0, 0, -3}), few);
    ASSERT_TRUE(held.held) << i;
    ASSERT_FALSE(held.contacts->complete);
    ASSERT_TRUE(is_same_place(held.tool, last)) << "where all pairs were known last, tick " << i;
    ASSERT_GT(held.wrench[2], 0.5) << "it gives no way";
  }
  for (int i = 0; i < 300; ++i) tick = simulation.tick(moved_by(start, {0, 0, -3}));
  EXPECT_FALSE(tick.held);
  EXPECT_FALSE(is_same_place(tick.tool, last)) << "it moves again";
}

}  // namespace
}  // namespace ist::test
