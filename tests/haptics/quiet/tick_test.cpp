// A tick of a scene with all effects, through its device and its records, allocates nothing and
// makes no system call.

#include <gtest/gtest.h>

#include <csignal>

#include "haptics/quiet/quiet_scene.h"
#include "ist/haptics/servo_loop.h"
#include "query/quiet/allocations.h"
#include "support/skip.h"
#include "support/system_calls.h"

namespace ist::test {
namespace {

constexpr int kTicks = 800;

// What a run came to: whether all effects had something to do.
struct Seen {
  double leaf_pairs = 0, force = 0;
  int held = 0, faults = 0, proximity = 0;

  void add(const Tick& tick) noexcept {
    leaf_pairs = std::max(leaf_pairs, tick.leaf_pairs);
    force = std::max(force, tick.wrench.norm());
    held += tick.held;
    faults += tick.fault;
    proximity += tick.proximity && tick.proximity->leaf_pairs > 0;
  }
  [[nodiscard]] bool all() const noexcept {
    return leaf_pairs > 5 && force > 0.5 && held > 5 && faults > 0 && proximity > 50;
  }
};

// Ticks from the first on: free, near and pressed; stopped by tests and by the clock; with a fault.
Seen run(BuiltScene& scene, TickRing<TickRecord>& ring, Snapshot<TickRecord>& snapshot) noexcept {
  Seen seen;
  for (int i = 0; i < kTicks; ++i) {
    TickBudget budget;
    if (i % 50 == 7) budget.contacts.tests = 20;
    if (i % 50 == 9) budget.contacts.deadline = Budget::Clock::now();
    if (i % 50 == 11) budget.proximity.tests = 2;
    const std::optional<Placement> at = i % 400 == 390 ? std::nullopt : scene.device->read();
    const Tick tick = scene.simulation->tick(at, budget);
    scene.device->write(tick.wrench, scene.simulation->dt());
    const TickRecord record = record_of(static_cast<std::uint64_t>(i), 1e-3, tick, at.has_value());
    static_cast<void>(ring.push(record));
    snapshot.publish(record);
    seen.add(tick);
  }
  return seen;
}

TEST(QuietTick, AllocatesNothing) {
  BuiltScene scene = build_scene(scene_with_all_effects());
  ASSERT_EQ(scene.simulation->effects().size(), 6u);
  TickRing<TickRecord> ring(256);
  Snapshot<TickRecord> snapshot;
  const std::uint64_t before = allocations();
  const Seen seen = run(scene, ring, snapshot);
  EXPECT_EQ(allocations() - before, 0u);
  EXPECT_TRUE(seen.all()) << seen.leaf_pairs << ' ' << seen.force << ' ' << seen.held << ' '
                          << seen.faults << ' ' << seen.proximity;
}

// So does the loop round it, but for what it begins and ends with.
TEST(QuietTick, NorDoesTheLoop) {
  const auto allocated = [](std::uint64_t ticks) {
    BuiltScene scene = build_scene(scene_with_all_effects());
    TickRing<TickRecord> ring(1 << 10);
    const std::atomic<bool> stop{false};
    const ServoOptions options{.ticks = ticks, .paced = false};
    const std::uint64_t before = allocations();
    const ServoReport report =
        run_servo_loop(*scene.simulation, *scene.device, options, {&ring, nullptr}, stop);
    EXPECT_EQ(report.ticks, ticks);
    return allocations() - before;
  };
  EXPECT_EQ(allocated(700), allocated(1));
}

TEST(QuietTick, MakesNoSystemCall) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  if (kSanitized) GTEST_SKIP() << "sanitizers call the system themselves";
  if (!can_forbid_system_calls()) IST_SKIP("this kernel does not filter system calls");
  EXPECT_EXIT(
      {
        BuiltScene scene = build_scene(scene_with_all_effects());
        TickRing<TickRecord> ring(256);
        Snapshot<TickRecord> snapshot;
        forbid_system_calls();
        const Seen seen = run(scene, ring, snapshot);
        end_process(seen.all() ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace ist::test
