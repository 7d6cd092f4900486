// What `ist advise` recommends for the jaws, for times and for errors: that it holds is to be seen
// where accuracy_bench has measured the whole curve.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "advise/calibration.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

void advise(benchmark::State& state, const AdviceGoal& goal) {
  VoxelAdvice advice;
  const auto& [fixed, moving] = exact_trees(0.4);
  for (auto _ : state) {
    const Stopwatch watch;
    ExactBodies bodies(fixed, moving);
    const auto path =
        find_closing_path(bodies, shortest_open_direction(bodies.fixed_box(), bodies.moving_box()));
    if (!path) {
      state.SkipWithError("the jaws pass each other");
      return;
    }
    Calibration calibration(bodies, *path, {});
    const SizeRange sizes = *sizes_between(bodies.fixed_box().diagonal().maxCoeff(),
                                           bodies.moving_box().diagonal().maxCoeff());
    advice = advise_voxel_size(goal, sizes, [&](double size) { return calibration.measure(size); });
    state.counters["seconds"] = 1e-3 * watch.milliseconds();
    state.counters["poses"] = static_cast<double>(kClosingPoses);
    state.counters["paths_beside"] = static_cast<double>(paths_beside(bodies, *path).size());
  }
  if (!advice.recommended) {
    state.SkipWithError("no voxel size is recommended");
    return;
  }
  const SizeMeasure& recommended = advice.measured[*advice.recommended];
  state.counters["part_of_limit"] = kOfGoal;
  state.counters["voxel_size"] = recommended.voxel_size;
  state.counters["error"] = recommended.error;
  state.counters["slowest_us"] = recommended.slowest_query;
  state.counters["sizes"] = static_cast<double>(advice.measured.size());
  state.SetLabel(pair_name());
}

void add(const std::string& name, const AdviceGoal& goal) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { advise(state, goal); })
      ->Unit(benchmark::kSecond)
      ->UseRealTime()
      ->Iterations(1);
}

const int kRegistered = [] {
  for (const double budget : {100.0, 300.0, 1000.0}) {
    if (budget == 100 || !quick()) {
      add(fmt::format("advise/budget/{:g}", budget),
          {AdviceGoal::Of::kSlowestQuery, kOfGoal * budget});
    }
  }
  for (const double error : {1.0, 0.5, 0.2, 0.1}) {
    if (error == 1 || !quick()) {
      add(fmt::format("advise/error/{:g}", error), {AdviceGoal::Of::kError, kOfGoal * error});
    }
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
