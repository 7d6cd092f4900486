#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <memory>
#include <string>

#include "ist/mesh/bounding_box.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/voxelizer.h"
#include "seed/sections.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/latencies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

double extent() { return bounding_box(lower_jaw()).diagonal().maxCoeff(); }

// Voxels and octree, without anything saved: what the article's figures 4, 5, 7 and 8 show.
void voxels(benchmark::State& state, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = SpherePolicy::kTable;
  Latencies voxel_times, octree_times;
  for (auto _ : state) {
    BuildReport report;
    const SphereTree tree = build_tree(lower_jaw(), options, &report);
    for (const BuildReport::Stage& stage : report.stages) {
      if (stage.name == std::string("voxels")) voxel_times.add(1e3 * stage.milliseconds);
      if (stage.name == std::string("octree")) octree_times.add(1e3 * stage.milliseconds);
    }
    state.counters["leaves"] = tree.leaf_count();
    state.counters["nodes"] = static_cast<double>(voxels_of(tree).octree.node_count());
    state.counters["cells"] = voxels_of(tree).lattice.cells;
    state.counters["depth"] = tree.depth();
    state.counters["MB"] = static_cast<double>(tree.bytes()) / 1e6;
  }
  state.counters["voxels_ms"] = 1e-3 * voxel_times.quantile(0.5);
  state.counters["octree_ms"] = 1e-3 * octree_times.quantile(0.5);
  state.counters["n"] = static_cast<double>(voxel_times.size());
  state.counters["extent"] = extent();
  state.counters["triangles"] = static_cast<double>(lower_jaw().triangles.size());
  state.SetLabel(pair_name());
}

void add_size(const std::string& name, double voxel_size) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) { voxels(state, voxel_size); })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

// Round the powers of two, to which the article's array is raised: folding alone, of voxels that
// are made before, all numbers of cells in turn.
class Folding {
 public:
  explicit Folding(std::vector<int> cells) : cells_(std::move(cells)) {}

  void report(benchmark::State& state, std::size_t at) {
    for (auto _ : state) {
      if (times_.empty()) measure();
      state.SetIterationTime(1e-6 * times_[at].quantile(0.5));
    }
    state.counters["cells"] = voxels_[at].lattice.cells;
    state.counters["leaves"] = static_cast<double>(voxels_[at].codes.size());
    state.counters["octree_ms"] = 1e-3 * times_[at].quantile(0.5);
    state.counters["n"] = static_cast<double>(times_[at].size());
    state.SetLabel(pair_name());
  }

 private:
  void measure() {
    for (const int cells : cells_) {
      // A little larger, so that rounding makes them no more.
      const double size = extent() / cells * (1 + 1e-12);
      voxels_.push_back(voxelize(lower_jaw(), {.voxel_size = size}));
    }
    times_.resize(cells_.size());
    for (int round = 0; round < rounds(101); ++round) {
      for (std::size_t i = 0; i < cells_.size(); ++i) {
        const Stopwatch watch;
        benchmark::DoNotOptimize(LinearOctree(voxels_[i].codes, voxels_[i].lattice.depth));
        times_[i].add(watch.microseconds());
      }
    }
  }

  std::vector<int> cells_;
  std::vector<VoxelSet> voxels_;
  std::vector<Latencies> times_;
};

void add_folding(const std::vector<int>& cells) {
  const auto folding = std::make_shared<Folding>(cells);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    benchmark::RegisterBenchmark(fmt::format("octree/{}", cells[i]).c_str(),
                                 [=](benchmark::State& state) { folding->report(state, i); })
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime()
        ->Iterations(1);
  }
}

}  // namespace

double published_unit() {
  constexpr double kPublishedExtent = 73.0;  // of the article's lower jaw, in its units
  return extent() / kPublishedExtent;
}

void add_voxels() {
  for (const double size : {10.0, 5.0, 2.0, 1.0, 0.8, 0.5, 0.4, 0.3, 0.2, 0.1, 0.05}) {
    if (size >= 0.2 || !quick()) add_size(fmt::format("voxels/{:g}", size), size);
  }
  // As many voxels along the jaw as the article has.
  for (const double size : {10.0, 5.0, 1.0}) {
    add_size(fmt::format("scaled/{:g}", size), size * published_unit());
  }
  add_folding({96,  112, 120, 126, 127, 128, 129, 130, 136, 160,
               192, 224, 240, 254, 255, 256, 257, 258, 272, 320});
}

}  // namespace ist::bench
