// A closing in small steps: time against contacts, and against how much of the bodies overlaps, by
// their triangles.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>
#include <iostream>
#include <memory>
#include <vector>

#include "scaling/asked.h"
#include "scaling/series.h"
#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {
namespace {

constexpr double kVoxelSize = 0.2;
constexpr std::size_t kTrianglePairs = 1 << 20;

std::vector<double> steps() {
  std::vector<double> steps;
  for (int i = 0; i <= 12; ++i) steps.push_back(0.25 * (i - 12));
  return steps;
}

std::vector<Asked> ask_steps() {
  std::vector<Eigen::Isometry3d> poses;
  for (const double dz : steps()) poses.push_back(closing(dz));
  return ask(triangle_trees(kVoxelSize), poses, {rounds(500)});
}

void report(benchmark::State& state, Series& series, std::size_t step) {
  const QueryResult result = series.report(state, step).result;
  const auto& [fixed, moving] = triangle_trees(kVoxelSize);
  Query query(fixed, moving);
  std::vector<TrianglePair> pairs(kTrianglePairs);
  const Eigen::Isometry3d pose = closing(steps()[step]);
  const std::uint64_t meet = query.triangle_pairs(pose, pairs).triangle_pairs;
  const DistanceInterval gap = query.distance(pose, 1e-3).distance;
  if (meet > 0 && (result.leaf_pairs == 0 || gap.lower > 0)) {
    std::cerr << "triangles meet, and no leaves do, at dz = " << steps()[step] << '\n';
    std::exit(1);
  }
  state.counters["voxel_size"] = kVoxelSize;
  state.counters["triangle_pairs"] = static_cast<double>(meet);
  state.counters["gap_mm"] = 0.5 * (gap.lower + gap.upper);
  state.SetLabel(pair_name());
}

}  // namespace

void add_overlap() {
  const auto series = std::make_shared<Series>(ask_steps);
  for (std::size_t step = 0; step < steps().size(); ++step) {
    benchmark::RegisterBenchmark(fmt::format("overlap/{:.2f}", steps()[step]).c_str(),
                                 [=](benchmark::State& state) { report(state, *series, step); })
        ->Unit(benchmark::kMicrosecond)
        ->UseManualTime()
        ->Iterations(1);
  }
}

}  // namespace ist::bench
