// A tick of two jaws that are pressed together: with no effects, with each alone, with all. What
// is not named costs nothing: neither time nor memory nor building.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "ist/scene.h"

namespace ist::bench {
namespace {

using Names = std::set<std::string>;

const Names kAll{"springs", "damping", "proximity", "gravity", "snap"};

// The built-in jaws, whatever others there are; closed by 4.5 mm within 0.3 s and then held there.
Scene pressed_jaws(double voxel_size, const Names& effects) {
  const auto waypoint = [](double time, double z) {
    return Waypoint{time, {Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, 1e-3 * z)}};
  };
  Scene scene{};
  scene.file = "bench";
  scene.unit = 1e-3;
  scene.fixed.front().source = BuiltInShape{.kind = BuiltInShape::Kind::kUpperJaw};
  scene.held.front().source = BuiltInShape{.kind = BuiltInShape::Kind::kLowerJaw};
  scene.fixed.front().voxel_size = scene.held.front().voxel_size = voxel_size;
  scene.held.front().translation = {0, 0, -5};
  scene.device = ScriptSettings{{.damping = 2, .angular_damping = 2e-3, .delay = 0},
                                {},
                                {waypoint(0, 0), waypoint(0.3, 4.5), waypoint(1e6, 4.5)}};
  scene.coupling = {1000, 0.5, 1, 5e-4, 5, 0.2};
  scene.safety = {8, 0.3, 500, 20, 0.1};
  if (effects.contains("springs")) scene.springs = SpringsSettings{};
  if (effects.contains("damping")) scene.damping = DampingSettings{};
  if (effects.contains("proximity")) scene.proximity = ProximitySettings{1e-3, 2};
  if (effects.contains("gravity")) scene.gravity = SceneGravity{0.05, std::nullopt, {0, 0, -9.81}};
  if (effects.contains("snap")) {
    scene.snap = SnapSettings{{Eigen::Matrix3d::Identity(), {0, 0, 4e-3}}, 200, 0.2, 1.5e-3, 0.1};
  }
  return scene;
}

double build_milliseconds(const BuiltScene& scene) {
  double sum = 0;
  for (const BuildNote& note : scene.notes) sum += note.milliseconds;
  return sum;
}

double megabytes(const BuiltScene& scene) {
  double sum = 0;
  for (const BuildNote& note : scene.notes) sum += 1e-6 * static_cast<double>(note.bytes);
  return sum;
}

void ticks(benchmark::State& state, double voxel_size, const Names& effects) {
  constexpr int kUntilPressed = 1000;
  const BuiltScene scene = build_scene(pressed_jaws(voxel_size, effects));
  Tick tick{};
  const auto turn = [&] {
    tick = scene.simulation->tick(scene.device->read(), {});
    scene.device->write(tick.wrench, scene.simulation->dt());
  };
  double force = 0;
  for (int i = 0; i < kUntilPressed; ++i) {
    turn();
    force = i < kUntilPressed / 2 ? 0 : std::max(force, tick.wrench.norm());
  }
  if (effects.contains("springs") && force < 0.1) {
    state.SkipWithError("the jaws are not pressed together");
    return;
  }
  for (auto _ : state) turn();
  state.SetItemsProcessed(state.iterations());
  state.counters["leaf_pairs"] = tick.leaf_pairs;
  if (tick.contacts) state.counters["contacts"] = static_cast<double>(tick.contacts->leaf_pairs);
  if (tick.proximity) state.counters["near"] = static_cast<double>(tick.proximity->leaf_pairs);
  state.SetLabel(
      fmt::format("{:.1f} MB, built in {:.0f} ms", megabytes(scene), build_milliseconds(scene)));
}

void add(double voxel_size, const std::string& name, const Names& effects) {
  benchmark::RegisterBenchmark(fmt::format("tick/{:.1f}/{}", voxel_size, name).c_str(),
                               [=](benchmark::State& state) { ticks(state, voxel_size, effects); })
      ->Unit(benchmark::kMicrosecond);
}

const int kRegistered = [] {
  for (const double voxel_size : {1.0, 0.4}) {
    add(voxel_size, "no_effects", {});
    for (const std::string& effect : kAll) {
      // Damping acts at contacts, and is no effect without.
      const bool needs_springs = effect == "damping";
      add(voxel_size, needs_springs ? "springs+" + effect : effect,
          needs_springs ? Names{"springs", effect} : Names{effect});
    }
    add(voxel_size, "all", kAll);
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
