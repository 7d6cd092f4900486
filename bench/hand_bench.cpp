// What accuracy costs in the hand: two jaws that are pressed together, slid and tilted, kept apart
// by `contact` and by `springs` of several voxel sizes. The time of each tick, and how far the gap
// and the force are off.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "hand/press.h"
#include "support/effort.h"
#include "support/latencies.h"

namespace ist::bench {
namespace {

constexpr double kDegrees = 57.29577951308232;
// A force below it has no direction to compare, N.
constexpr double kLeastForce = 0.05;

bool same(const std::vector<PressTick>& a, const std::vector<PressTick>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const PressTick& p, const PressTick& q) {
                      return p.tool.translation == q.tool.translation &&
                             p.tool.rotation == q.tool.rotation && p.force == q.force;
                    });
}

// The ticks of some rounds. The least time of all rounds counts for a tick.
std::vector<PressTick> measured(const Jaws& jaws, const Keeper& keeper, int count) {
  std::vector<PressTick> ticks = Press(jaws, keeper).run();
  for (int round = 1; round < count; ++round) {
    const std::vector<PressTick> again = Press(jaws, keeper).run();
    if (!same(ticks, again)) return {};
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      ticks[i].microseconds = std::min(ticks[i].microseconds, again[i].microseconds);
    }
  }
  return ticks;
}

// Counters of the ticks of a phase, or of all.
void report(benchmark::State& state, const std::vector<PressTick>& ticks, const std::string& name,
            const std::optional<Phase>& phase) {
  Latencies times;
  double steps = 0, held = 0, halved = 0, searched = 0;
  for (const PressTick& tick : ticks) {
    if (phase && tick.phase != *phase) continue;
    times.add(tick.microseconds);
    steps += tick.steps;
    held += tick.held ? 1 : 0;
    halved += tick.halved ? 1 : 0;
    searched += tick.searched ? 1 : 0;
  }
  times.report(state, name + "_");
  const auto count = static_cast<double>(times.size());
  state.counters[name + "_ticks"] = count;
  state.counters[name + "_steps"] = steps / count;
  state.counters[name + "_held"] = held;
  state.counters[name + "_halved"] = halved;
  state.counters[name + "_searched"] = searched;
}

void ticks(benchmark::State& state, const Jaws& jaws, const Keeper& keeper) {
  std::vector<PressTick> made;
  const int count = quick() ? 2 : 5;
  for (auto _ : state) made = measured(jaws, keeper, count);
  if (made.empty()) {
    state.SkipWithError("two runs differ");
    return;
  }
  for (int phase = 0; phase < kPhases; ++phase) {
    const auto of = static_cast<Phase>(phase);
    report(state, made, to_string(of), of);
  }
  report(state, made, "all", std::nullopt);
  state.counters["rounds"] = count;
  state.SetLabel(jaws.name);
}

// The converged forces of the reference at the device's poses, which are the same in each run.
const Converged& reference(const Jaws& jaws, const std::vector<PressTick>& of) {
  static std::map<std::string, Converged> made;
  Converged& found = made[jaws.name];
  if (found.forces.empty()) found = Press(jaws, {.is_reference = true}).converge(of);
  return found;
}

void accuracy(benchmark::State& state, const Jaws& jaws, const Keeper& keeper) {
  Press press(jaws, keeper);
  std::vector<PressTick> made;
  for (auto _ : state) made = press.run();
  const auto& [truth, restless] = reference(jaws, made);
  Latencies off, parts, angles;
  double change = 0, none = 0;
  const PressTick* rest = nullptr;
  for (std::size_t i = 0; i < made.size(); ++i) {
    const PressTick& tick = made[i];
    if (tick.phase == Phase::kRests) rest = &tick;
    if (i > 0) change = std::max(change, (tick.force - made[i - 1].force).norm());
    const double length = truth[i].norm();
    if (length < kLeastForce) continue;
    off.add((tick.force - truth[i]).norm());
    parts.add(std::abs(tick.force.norm() / length - 1));
    if (tick.force.norm() < kLeastForce) {
      ++none;
    } else {
      angles.add(kDegrees *
                 std::atan2(tick.force.cross(truth[i]).norm(), tick.force.dot(truth[i])));
    }
  }
  if (rest == nullptr || angles.size() == 0) {
    state.SkipWithError("nothing is pressed");
    return;
  }
  state.counters["gap_mm"] = gap_at(jaws, press.pose_of(rest->tool));
  state.counters["rest_force_N"] = rest->force.norm();
  double deepest = HUGE_VAL;
  for (std::size_t i = 0; i < made.size(); i += quick() ? 400U : 50U) {
    deepest = std::min(deepest, gap_at(jaws, press.pose_of(made[i].tool)));
  }
  state.counters["least_gap_mm"] = deepest;
  state.counters["off_p50_N"] = off.quantile(0.5);
  state.counters["off_max_N"] = off.quantile(1);
  state.counters["length_p50"] = parts.quantile(0.5);
  state.counters["length_max"] = parts.quantile(1);
  state.counters["angle_p50"] = angles.quantile(0.5);
  state.counters["angle_max"] = angles.quantile(1);
  state.counters["none"] = none;
  state.counters["change_N"] = change;
  state.counters["restless"] = restless;
  state.counters["n"] = static_cast<double>(off.size());
  state.SetLabel(jaws.name);
}

void add(const Jaws& jaws, const Keeper& keeper) {
  const std::string name =
      keeper.voxel_size ? fmt::format("springs/{:g}", *keeper.voxel_size) : "contact/any";
  const auto once = [](benchmark::internal::Benchmark* made) {
    made->Unit(benchmark::kMillisecond)->Iterations(1);
  };
  once(benchmark::RegisterBenchmark(
      fmt::format("ticks/{}/{}/{}", jaws.name, name, keeper.workers).c_str(),
      [&jaws, keeper](benchmark::State& state) { ticks(state, jaws, keeper); }));
  if (keeper.workers > 1) return;
  once(benchmark::RegisterBenchmark(
      fmt::format("accuracy/{}/{}", jaws.name, name).c_str(),
      [&jaws, keeper](benchmark::State& state) { accuracy(state, jaws, keeper); }));
}

const int kRegistered = [] {
  for (const Jaws& jaws : pairs_of_jaws()) {
    for (const int workers : {1, 2}) {
      add(jaws, {.workers = workers});
      for (const double size : {0.8, 0.4, 0.2}) add(jaws, {.voxel_size = size, .workers = workers});
    }
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
