// A tick with five bodies, and what the hand takes and releases, are as quiet as a tick with two.

#include <gtest/gtest.h>

#include "haptics/bodies/body_cases.h"
#include "ist/haptics/recording.h"
#include "query/quiet/allocations.h"
#include "query/quiet/locks.h"
#include "support/skip.h"
#include "support/system_calls.h"

namespace ist::test {
namespace {

constexpr std::size_t kLooseBall = 3;

// The hand presses the tool on the floor, and then the ball that it takes, by plan and by call. A
// plate under them moves.
Scene busy_bodies() {
  const auto at = [](double time, double y, double z) {
    return Waypoint{time, {Eigen::Matrix3d::Identity(), {0, 1e-3 * y, 1e-3 * z}}};
  };
  Scene scene = five_bodies();
  scene.fixed.front().script = {at(0, 0, 0), at(2, 0.2, 0)};
  scene.proximity = ProximitySettings{2e-3, 2};
  scene.device = HandSettings{.plan = {at(0, 0, 0), at(0.3, 0, -3), at(0.6, 0, 5), at(0.9, 0, 5),
                                       at(1.2, 0, 1), at(1.5, 0, 5), at(2, 0, 5)}};
  scene.safety.soft_start = 0.1;
  scene.changes = {{0.8, "loose", true}, {1.7, "loose", false}};
  return scene;
}

struct Done {
  double force = 0, leaf_pairs = 0;
  int held = 0, planned = 0, called = 0, refused = 0;

  [[nodiscard]] bool all() const noexcept {
    return force > 0.5 && leaf_pairs > 5 && held > 5 && planned == 2 && called == 2 && refused == 2;
  }
};

Done run_bodies(BuiltScene& scene, TickRing<TickRecord>& ring) noexcept {
  Done done;
  Simulation& simulation = *scene.simulation;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    TickBudget budget;
    if (i % 50 == 7) budget.contacts.tests = 20;
    if (i % 50 == 9) budget.contacts.deadline = Budget::Clock::now();
    if (i % 50 == 11) budget.contacts.deadline = Budget::Clock::now() + std::chrono::hours(1);
    if (i == 250) done.refused += simulation.attach(kLooseBall) == ChangeStatus::kTouching;
    if (i == 1850) done.called += simulation.attach(kLooseBall) == ChangeStatus::kDone;
    if (i == 1900) done.called += simulation.release(kLooseBall) == ChangeStatus::kDone;
    if (i == 1950) done.refused += simulation.release(kLooseBall) != ChangeStatus::kDone;
    const Tick tick = simulation.tick(scene.device->read(), budget);
    scene.device->write(tick.wrench, simulation.dt());
    static_cast<void>(ring.push(record_of(i, simulation.dt(), tick, true)));
    done.force = std::max(done.force, tick.wrench.norm());
    done.leaf_pairs = std::max(done.leaf_pairs, tick.leaf_pairs);
    done.held += tick.held;
    done.planned += tick.change && tick.change->status == ChangeStatus::kDone;
  }
  return done;
}

TEST(QuietTick, OfFiveBodiesAllocatesAndLocksNothing) {
  BuiltScene scene = build_scene(busy_bodies());
  TickRing<TickRecord> ring(256);
  const std::uint64_t allocated = allocations(), locked = locks();
  const Done done = run_bodies(scene, ring);
  EXPECT_EQ(allocations() - allocated, 0u);
  EXPECT_EQ(locks() - locked, 0u);
  EXPECT_TRUE(done.all()) << done.force << ' ' << done.leaf_pairs << ' ' << done.held << ' '
                          << done.planned << ' ' << done.called << ' ' << done.refused;
}

TEST(QuietTick, OfFiveBodiesMakesNoSystemCall) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  if (kSanitized) GTEST_SKIP() << "sanitizers call the system themselves";
  if (!can_forbid_system_calls()) IST_SKIP("this kernel does not filter system calls");
  EXPECT_EXIT(
      {
        BuiltScene scene = build_scene(busy_bodies());
        TickRing<TickRecord> ring(256);
        forbid_system_calls();
        const Done done = run_bodies(scene, ring);
        end_process(done.all() ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace ist::test
