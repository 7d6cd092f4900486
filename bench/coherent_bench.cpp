// Ticks whose leaf pairs are kept from one pose to the next, beside those that search anew: query
// and sums over motions recorded from a simulated hand and others. Both answer every tick, turn and
// turn about; of every tick the least time of several rounds counts.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "coherent/motions.h"
#include "ist/query/query.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/latencies.h"
#include "support/pacer.h"

namespace ist::bench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kFrontPairs = 1 << 17;
// What a haptic loop asks for.
constexpr ManifoldOptions kManifold{.points = 0, .margin = 0.25, .reach = 0.375};

// The trees of a voxel size and the motions, made once.
struct Jaws {
  explicit Jaws(double voxel_size)
      : scene(scene_of_jaws(voxel_size)), trees(build_scene(scene).trees) {}

  const Poses& poses(const Motion& motion) {
    const auto found = made.find(motion.name);
    return found != made.end() ? found->second
                               : made.emplace(motion.name, motion.make(scene)).first->second;
  }

  Scene scene;
  std::vector<BodyTrees> trees;  // of the fixed body, and of the held one
  std::map<std::string, Poses> made;
};

Jaws& jaws(double voxel_size) {
  static std::map<double, Jaws> made;
  return made.try_emplace(voxel_size, voxel_size).first->second;
}

bool same(const QueryResult& a, const ContactManifold& of_a, const QueryResult& b,
          const ContactManifold& of_b) {
  const auto bits = [](const Wrench& x, const Wrench& y) {
    return x.force == y.force && x.torque == y.torque;
  };
  return a.leaf_pairs == b.leaf_pairs && a.complete && b.complete &&
         of_a.sums().weight == of_b.sums().weight && of_a.sums().pairs == of_b.sums().pairs &&
         bits(of_a.sums().pressure, of_b.sums().pressure) &&
         bits(of_a.sums().spring, of_b.sums().spring);
}

// A way to answer, and the least time of each tick.
struct Way {
  Query query;
  ContactManifold manifold;
  std::vector<double> least;
  QueryResult result = {};

  Way(const std::vector<BodyTrees>& of, const QueryOptions& options, std::size_t ticks)
      : query(*of.front().contact, *of.back().contact, options),
        manifold(*of.front().contact, *of.back().contact, query.policy(), kManifold),
        least(ticks, HUGE_VAL) {}

  void answer(std::size_t tick, const Eigen::Isometry3d& pose) {
    const Clock::time_point begin = Clock::now();
    result = query.contacts(pose, manifold);
    const std::chrono::duration<double, std::micro> time = Clock::now() - begin;
    least[tick] = std::min(least[tick], time.count());
  }
  [[nodiscard]] double report(benchmark::State& state, const std::string& name) const {
    Latencies latencies;
    double sum = 0;
    for (const double time : least) {
      latencies.add(time);
      sum += time;
    }
    latencies.report(state, name + "_");
    const double mean = sum / static_cast<double>(least.size());
    state.counters[name + "_mean_us"] = mean;
    return mean;
  }
};

void ticks(benchmark::State& state, double voxel_size, const Motion& motion, int workers) {
  Jaws& of = jaws(voxel_size);
  const Poses& poses = of.poses(motion);
  Way fresh(of.trees, {}, poses.size());
  Way kept(of.trees, {.workers = workers, .front_pairs = kFrontPairs}, poses.size());
  std::size_t by[3] = {};
  int round = 0;
  for (auto _ : state) {
    Pacer pacer(std::chrono::milliseconds(1));
    std::fill(std::begin(by), std::end(by), 0);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (workers == 2) pacer.wait();
      if (round % 2 == 0) fresh.answer(i, poses[i]);
      kept.answer(i, poses[i]);
      if (round % 2 == 1) fresh.answer(i, poses[i]);
      ++by[static_cast<std::size_t>(kept.result.found)];
      if (same(fresh.result, fresh.manifold, kept.result, kept.manifold)) continue;
      state.SkipWithError("an answer depends on what was kept");
      return;
    }
    ++round;
  }
  const double before = fresh.report(state, "fresh"), after = kept.report(state, "kept");
  state.counters["mean_ratio"] = after / before;
  for (const char* of_all : {"p99_us", "max_us"}) {
    state.counters[std::string(of_all).substr(0, 3) + "_ratio"] =
        state.counters[std::string("kept_") + of_all] /
        state.counters[std::string("fresh_") + of_all];
  }
  Latencies moved;
  for (const double step : steps(poses)) moved.add(step / voxel_size);
  state.counters["step_p50_voxels"] = moved.quantile(0.5);
  state.counters["step_max_voxels"] = moved.quantile(1);
  state.counters["rounds"] = round;
  state.counters["room"] = static_cast<double>(kFrontPairs);
  state.counters["ticks"] = static_cast<double>(poses.size());
  state.counters["by_search"] = static_cast<double>(by[0]);
  state.counters["among_kept"] = static_cast<double>(by[1]);
  state.counters["in_clearance"] = static_cast<double>(by[2]);
  state.counters["MB"] = static_cast<double>(kept.query.bytes()) / 1e6;
  state.SetLabel(pair_name());
}

void add(double size, const Motion& motion, int workers) {
  const std::string name = fmt::format("ticks/{}/{}/{}", size, motion.name, workers);
  benchmark::RegisterBenchmark(
      name.c_str(), [=](benchmark::State& state) { ticks(state, size, motion, workers); })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->Iterations(quick() ? 2 : 3);
}

const int kRegistered = [] {
  const std::vector<double> sizes = quick() ? std::vector<double>{0.8} : std::vector{0.8, 0.2};
  for (const double size : sizes) {
    for (const Motion& motion : motions()) add(size, motion, 1);
  }
  // Ticks with a second worker are paced at 1 kHz, so few motions are asked.
  for (const Motion& motion : motions()) {
    if (motion.with_two_workers) add(sizes.back(), motion, 2);
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
