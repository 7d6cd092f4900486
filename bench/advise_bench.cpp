// Advice of `ist advise` for the jaws, for times and for errors. accuracy_bench measures the whole
// curve, so the report can compare both.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "advise/voxel_advice.h"
#include "ist/mesh/bounding_box.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

double extent_of(const SphereTree& tree) {
  return bounding_box(*tree.triangles()).diagonal().maxCoeff();
}

void advise(benchmark::State& state, const AdviceGoal& goal) {
  VoxelAdvice advice;
  const auto& [fixed, moving] = triangle_trees(0.4);
  for (auto _ : state) {
    const Stopwatch watch;
    Query exact(fixed, moving);
    Progress progress;
    const auto path = find_closing_path(exact, shortest_open_direction(fixed, moving));
    if (!path) {
      state.SkipWithError("the jaws pass each other");
      return;
    }
    const double coarsest = *coarsest_size(extent_of(fixed), extent_of(moving));
    advice = advise_voxel_size(goal, coarsest, [&](double size) {
      return measure_size(exact, path->poses(), path, size, {}, progress);
    });
    state.counters["seconds"] = 1e-3 * watch.milliseconds();
  }
  if (!advice.recommended) {
    state.SkipWithError("no voxel size is recommended");
    return;
  }
  const SizeMeasure& recommended = advice.measured[*advice.recommended];
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
    if (budget > 100 && quick()) continue;
    add(fmt::format("advise/budget/{:g}", budget),
        {AdviceGoal::Of::kSlowestQuery, kOfGoal * budget});
  }
  for (const double error : {1.0, 0.5, 0.2, 0.1}) {
    if (error < 1 && quick()) continue;
    add(fmt::format("advise/error/{:g}", error), {AdviceGoal::Of::kError, kOfGoal * error});
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
