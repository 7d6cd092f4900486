// From mesh to tree, by voxel size: time of each stage, memory, bytes; and without voxels.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "ist/tree/tree_parts.h"
#include "support/bodies.h"
#include "support/peak_memory.h"

namespace ist::bench {
namespace {

void build_upper_jaw(benchmark::State& state, double voxel_size, SpherePolicy policy) {
  const TriangleMesh& mesh = upper_jaw();
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = policy;
  options.max_memory = std::uint64_t{16} << 30;
  reset_peak_memory();
  std::map<std::string, std::vector<double>> stages;
  for (auto _ : state) {
    BuildReport report;
    const SphereTree tree = build_tree(mesh, options, &report);
    for (const auto& stage : report.stages) stages[stage.name].push_back(stage.milliseconds);
    state.counters["leaves"] = tree.leaf_count();
    state.counters["nodes"] = static_cast<double>(voxels_of(tree).octree.node_count());
    state.counters["tree_MB"] = static_cast<double>(tree.bytes()) / 1e6;
  }
  state.counters["peak_MB"] = peak_memory_mb();
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
  for (auto& [name, times] : stages) {
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                     times.end());
    std::string key = name + "_ms";
    std::replace(key.begin(), key.end(), ' ', '_');
    state.counters[key] = times[times.size() / 2];
  }
  state.SetLabel(pair_name());
}

// Trees of triangles alone, of both jaws, one after the other.
void build_triangles(benchmark::State& state) {
  const TriangleMesh &upper = upper_jaw(), &lower = lower_jaw();
  std::uint64_t bytes = 0;
  for (auto _ : state) bytes = build_tree(upper).bytes() + build_tree(lower).bytes();
  state.counters["triangles"] =
      static_cast<double>(upper.triangles.size() + lower.triangles.size());
  state.counters["tree_MB"] = static_cast<double>(bytes) / 1e6;
  state.SetLabel(pair_name());
}

const int kRegistered = [] {
  benchmark::RegisterBenchmark("triangles_alone/both_jaws", build_triangles)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
  for (const auto policy : {SpherePolicy::kTable, SpherePolicy::kTight, SpherePolicy::kSlab}) {
    for (const double size : {0.8, 0.6, 0.4, 0.3, 0.2, 0.15, 0.1}) {
      const std::string name =
          "build/" + std::string(to_string(policy)) + "/" + std::to_string(size).substr(0, 4);
      benchmark::RegisterBenchmark(
          name.c_str(), [=](benchmark::State& state) { build_upper_jaw(state, size, policy); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    }
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
