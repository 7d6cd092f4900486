// In any arithmetic of the caller: scenes, their ticks, and plans.
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "ist/haptics.h"
#include "ist/haptics/recording.h"
#include "ist/haptics/servo_callback.h"
#include "ist/scene.h"
#include "scene/scene_text.h"
#include "stability/float_environment_case.h"

namespace ist::test {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;

void add(Record& record, const Placement& place) {
  for (const double number : to_numbers(place)) record.add(number);
}
void add(Record& record, const Vector6& six) {
  for (const double number : six) record.add(number);
}

class FloatEnvironmentOfAScene : public FloatEnvironmentOfTheCaller {
 protected:
  // The tool begins free of the box, and presses on it 10 ms later.
  const std::filesystem::path file_ = folder_.write(
      "scene.toml",
      replaced(replaced(kSoundScene, "move = [0, 0, 0] }", "move = [0, 0, 11] }"),
               "{ time = 1, move = [0, 0, -4] }", "{ time = 0.02, move = [0, 0, 9] }"));
};

INSTANTIATE_TEST_SUITE_P(Once, FloatEnvironmentOfAScene, ::testing::Values(1.0),
                         [](const auto&) { return std::string("one"); });

TEST_P(FloatEnvironmentOfAScene, ChangesNoSceneThatIsRead) {
  changes_nothing("read_scene", 16, [&](Record& record) {
    const ist::Scene scene = read_scene(file_);
    record.add(*scene.fixed.front().voxel_size);
    record.add(*scene.held.front().voxel_size);
    record.add(scene.rate);
  });
}

TEST_P(FloatEnvironmentOfAScene, ChangesNoPlan) {
  const std::filesystem::path plan = folder_.write(
      "plan.csv", "time,x,y,z,qw,qx,qy,qz\n0,0.1,0.2,0.3,1,0,0,0\n1.5,0.7,0,0,0.9,0.1,0.2,0.3\n");
  changes_nothing("read_script and make_script_device", 500, [&](Record& record) {
    const std::vector<Waypoint> read = read_script(plan, kMetresPerMillimetre);
    for (const Waypoint& waypoint : read) {
      record.add(waypoint.time);
      add(record, waypoint.pose);
    }
    const std::unique_ptr<Device> device = make_script_device(read);
    for (int tick = 0; tick < 5; ++tick) {
      add(record, device->read().value());
      device->write(Vector6::Zero(), 0.3);
    }
  });
}

TEST_P(FloatEnvironmentOfAScene, ChangesNoTick) {
  changes_nothing("build_scene, Simulation::tick and a simulated hand", 5000, [&](Record& record) {
    const BuiltScene built = build_scene(read_scene(file_));
    record.add(built.step_limit);
    for (int number = 0; number < 50; ++number) {
      const Tick tick = built.simulation->tick(built.device->read());
      built.device->write(tick.wrench, built.simulation->dt());
      add(record, tick.device);
      add(record, tick.tool);
      add(record, tick.wrench);
    }
  });
}

// Each tick from the record of one that was made before, and two without a pose or a test.
TEST_P(FloatEnvironmentOfAScene, ChangesNoTickThatIsReplayed) {
  std::vector<RecordedTick> recorded;
  {
    const BuiltScene built = build_scene(read_scene(file_));
    for (std::uint64_t number = 0; number < 40; ++number) {
      const std::optional<Placement> device = built.device->read();
      const Tick tick = built.simulation->tick(device);
      built.device->write(tick.wrench, built.simulation->dt());
      recorded.push_back({.tick = number, .device = device});
    }
  }
  recorded[31].device.reset();
  recorded[35].budget.contacts.tests = 0;
  changes_nothing("replay", 5000, [&](Record& record) {
    const BuiltScene built = build_scene(read_scene(file_));
    for (const RecordedTick& tick : recorded) {
      const TickRecord replayed = replay(tick, *built.simulation);
      record.add(replayed.tick);
      record.add(replayed.dt);
      for (const double number : replayed.device) record.add(number);
      for (const double number : replayed.tool) record.add(number);
      for (const double number : replayed.wrench) record.add(number);
      record.add(replayed.held);
      record.add(replayed.leaf_pairs);
      if (replayed.contacts) record.add(replayed.contacts->sphere_tests);
    }
  });
}

TEST_P(FloatEnvironmentOfAScene, ChangesNoCallOfADriver) {
  changes_nothing("ServoCallback::on_tick", 1000, [&](Record& record) {
    const BuiltScene built = build_scene(read_scene(file_));
    ServoCallbackOptions options;
    options.unit = kMetresPerMillimetre;
    options.sphere_tests = 1'000'000;  // so that no clock counts
    ServoCallback callback(*built.simulation, options);
    ServoCallback::Pose pose = callback.tool();
    std::array<double, 3> force{}, torque{};
    for (int number = 0; number < 20; ++number) {
      static_cast<void>(callback.on_tick(pose, force, torque));
      for (const double each : force) record.add(each);
      for (const double each : torque) record.add(each);
    }
    for (const double each : callback.tool()) record.add(each);
  });
}

TEST_P(FloatEnvironmentOfAScene, ChangesNoPlacement) {
  Placement from, to;
  to.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  to.translation = {0.1, 0.2, 0.3};
  Vector6 motion;
  motion << 0.01, 0.02, 0.03, 0.1, 0.2, 0.3;
  changes_nothing("Placement::moved, motion_between and to_placement", 200, [&](Record& record) {
    add(record, motion_between(from, to));
    add(record, to.moved(motion));
    add(record, to.integrated_fast(motion));
    add(record, to_placement(to_numbers(to.moved(motion))).value());
  });
}

// A tenth of ten times is one of them, but more than one where 0.1 · 10 is rounded up.
TEST_P(FloatEnvironmentOfAScene, ChangesNoQuantile) {
  LatencyHistogram times;
  for (int i = 1; i <= 10; ++i) times.record(std::chrono::microseconds(100 * i));
  changes_nothing("LatencyHistogram::quantile", 8,
                  [&](Record& record) { record.add(times.quantile(0.1).count()); });
}

}  // namespace
}  // namespace ist::test
