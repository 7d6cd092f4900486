#include <gtest/gtest.h>

#include <csignal>

#include "haptics/bodies/body_cases.h"
#include "ist/haptics/recording.h"
#include "ist/haptics/servo_loop.h"
#include "ist/scene.h"
#include "query/quiet/allocations.h"
#include "query/quiet/locks.h"
#include "support/effort.h"
#include "support/system_calls.h"

namespace ist::test {
namespace {

// A ball that a hand puts on a box and pushes along, with every effect. Millimetres, 1 kHz.
Scene scene_with_all_effects(Keeps keeps) {
  const auto waypoint = [](double time, double x, double z) {
    return Waypoint{time, {Eigen::Matrix3d::Identity(), 1e-3 * Eigen::Vector3d(x, 0, z)}};
  };
  Scene scene{.unit = 1e-3};
  scene.fixed = {box_body("box", {-20, -20, -5}, {20, 20, 5})};
  scene.held = {ball_body("ball", {0, 0, 11}, 5)};
  HandSettings hand{};
  hand.mechanics = {2, 2e-3, 0};
  hand.mass = 0.2;
  hand.inertia = 2e-4;
  hand.arm_stiffness = 500;
  hand.arm_damping = 10;
  hand.arm_angular_stiffness = 1;
  hand.arm_angular_damping = 0.02;
  hand.plan = {waypoint(0, 0, 0), waypoint(0.3, 0, -3), waypoint(0.8, 5, -3)};
  scene.device = hand;
  scene.coupling = {1000, 0.5, 1, 5e-4, 5, 0.2};
  scene.safety = {8, 0.3, 500, 20, 0.1};
  keep_apart(scene, keeps, {.stiffness = 20000});
  if (keeps == Keeps::kContact) scene.friction = FrictionSettings{};
  scene.damping = DampingSettings{10};
  scene.proximity = ProximitySettings{2e-3, 2};
  scene.gravity = SceneGravity{0.05, std::nullopt, {0, 0, -9.81}};
  scene.snap = SnapSettings{{Eigen::Matrix3d::Identity(), {5e-3, 0, -1e-3}}, 200, 0.2, 5e-3, 0.2};
  return scene;
}

// A tick of a scene with all effects, through its device and its records, allocates nothing and
// makes no system call.

constexpr int kTicks = 800;

double contacts_of(const Tick& tick) noexcept {
  return tick.leaf_pairs + static_cast<double>(tick.points.size());
}

// The largest values and the counts of a run. They show whether every effect acted.
struct Seen {
  double contacts = 0, force = 0;
  int held = 0, faults = 0, proximity = 0;

  void add(const Tick& tick) noexcept {
    contacts = std::max(contacts, contacts_of(tick));
    force = std::max(force, tick.wrench.norm());
    held += tick.held;
    faults += tick.fault;
    proximity += tick.proximity && tick.proximity->leaf_pairs > 0;
  }
  [[nodiscard]] bool all() const noexcept {
    return contacts > 0.2 && force > 0.5 && held > 5 && faults > 0 && proximity > 50;
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

class QuietTick : public ::testing::TestWithParam<Keeps> {};
INSTANTIATE_TEST_SUITE_P(, QuietTick, ::testing::Values(Keeps::kContact, Keeps::kSprings), name_of);

TEST_P(QuietTick, AllocatesNothing) {
  BuiltScene scene = build_scene(scene_with_all_effects(GetParam()));
  ASSERT_EQ(scene.simulation->effects().size(), GetParam() == Keeps::kSprings ? 5u : 4u);
  TickRing<TickRecord> ring(256);
  Snapshot<TickRecord> snapshot;
  const std::uint64_t before = allocations();
  const Seen seen = run(scene, ring, snapshot);
  EXPECT_EQ(allocations() - before, 0u);
  EXPECT_TRUE(seen.all()) << seen.contacts << ' ' << seen.force << ' ' << seen.held << ' '
                          << seen.faults << ' ' << seen.proximity;
}

// The loop around the tick allocates as much for 700 ticks as for one.
TEST_P(QuietTick, NorDoesTheLoop) {
  const auto allocated = [](std::uint64_t ticks) {
    BuiltScene scene = build_scene(scene_with_all_effects(GetParam()));
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

TEST_P(QuietTick, MakesNoSystemCall) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  if (kSanitized) GTEST_SKIP() << "sanitizers call the system themselves";
  if (!can_forbid_system_calls()) IST_SKIP("this kernel does not filter system calls");
  EXPECT_EXIT(
      {
        BuiltScene scene = build_scene(scene_with_all_effects(GetParam()));
        TickRing<TickRecord> ring(256);
        Snapshot<TickRecord> snapshot;
        forbid_system_calls();
        const Seen seen = run(scene, ring, snapshot);
        end_process(seen.all() ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

// A tick with five bodies is as quiet as a tick with two, also if the hand takes or releases one.

constexpr std::size_t kLooseBall = 3;

// The hand presses the tool on the floor, and then the ball that it takes, by plan and by call. A
// plate under them moves.
Scene busy_bodies(Keeps keeps) {
  const auto at = [](double time, double y, double z) {
    return Waypoint{time, {Eigen::Matrix3d::Identity(), {0, 1e-3 * y, 1e-3 * z}}};
  };
  Scene scene = five_bodies(keeps);
  scene.fixed.front().script = {at(0, 0, 0), at(2, 0.2, 0)};
  scene.proximity = ProximitySettings{2e-3, 2};
  scene.device = HandSettings{.plan = {at(0, 0, 0), at(0.3, 0, -3), at(0.6, 0, 5), at(0.9, 0, 5),
                                       at(1.2, 0, 1), at(1.5, 0, 5), at(2, 0, 5)}};
  scene.safety.soft_start = 0.1;
  scene.changes = {{0.8, "loose", true}, {1.7, "loose", false}};
  return scene;
}

struct Done {
  double force = 0, contacts = 0;
  int held = 0, planned = 0, called = 0, refused = 0;

  [[nodiscard]] bool all() const noexcept {
    return force > 0.5 && contacts > 0.2 && held > 5 && planned == 2 && called == 2 && refused == 2;
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
    done.contacts = std::max(done.contacts, contacts_of(tick));
    done.held += tick.held;
    done.planned += tick.change && tick.change->status == ChangeStatus::kDone;
  }
  return done;
}

TEST_P(QuietTick, OfFiveBodiesAllocatesAndLocksNothing) {
  BuiltScene scene = build_scene(busy_bodies(GetParam()));
  TickRing<TickRecord> ring(256);
  const std::uint64_t allocated = allocations(), locked = locks();
  const Done done = run_bodies(scene, ring);
  EXPECT_EQ(allocations() - allocated, 0u);
  EXPECT_EQ(locks() - locked, 0u);
  EXPECT_TRUE(done.all()) << done.force << ' ' << done.contacts << ' ' << done.held << ' '
                          << done.planned << ' ' << done.called << ' ' << done.refused;
}

TEST_P(QuietTick, OfFiveBodiesMakesNoSystemCall) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  if (kSanitized) GTEST_SKIP() << "sanitizers call the system themselves";
  if (!can_forbid_system_calls()) IST_SKIP("this kernel does not filter system calls");
  EXPECT_EXIT(
      {
        BuiltScene scene = build_scene(busy_bodies(GetParam()));
        TickRing<TickRecord> ring(256);
        forbid_system_calls();
        const Done done = run_bodies(scene, ring);
        end_process(done.all() ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace ist::test
