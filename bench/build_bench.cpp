// From mesh to tree: time of each stage, memory, bytes.
//
//   build/POLICY/SIZE         the upper jaw, by voxel size
//   stages/SIZE/THREADS       both jaws, from files to trees and back, each stage by wall time and
//                             by processor time; SIZE 0: triangles alone, else `slab`. Other
//                             libraries' builds of the same meshes: peers/build of peers_bench
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ist/base/parallel.h"
#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/tree/bound_builder.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/voxelizer.h"
#include "support/bodies.h"
#include "support/peak_memory.h"
#include "support/stopwatch.h"

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

// The median of each stage's times.
class StageTimes {
 public:
  template <typename Run>
  void time(const char* stage, const Run& run) {
    const std::clock_t before = std::clock();
    const Stopwatch watch;
    run();
    const double wall = watch.milliseconds();
    now_[std::string(stage) + "_ms"] += wall;
    now_[std::string(stage) + "_cpu_ms"] +=
        1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  }
  void end_round() {
    for (const auto& [key, time] : std::exchange(now_, {})) all_[key].push_back(time);
  }
  void put(benchmark::State& state) {
    for (auto& [key, times] : all_) {
      const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
      std::nth_element(times.begin(), middle, times.end());
      state.counters[key] = *middle;
    }
  }

 private:
  std::map<std::string, double> now_;
  std::map<std::string, std::vector<double>> all_;
};

// The stages of build_tree(), one by one.
void run_stages(TriangleMesh mesh, double voxel_size, StageTimes& times) {
  times.time("weld", [&] { weld(mesh); });
  times.time("orient", [&] { static_cast<void>(orient_outward(mesh)); });
  times.time("clusters",
             [&] { benchmark::DoNotOptimize(TriangleClusters(mesh, mesh.vertices[0])); });
  if (voxel_size == 0) return;
  VoxelizerOptions options{.voxel_size = voxel_size, .keep_triangles = true};
  times.time("voxels", [&] { benchmark::DoNotOptimize(voxelize(mesh, options)); });
  BoundBuilder builder(SpherePolicy::kSlab);
  options.visitor = &builder;
  VoxelSet voxels;
  times.time("voxels_and_leaves", [&] { voxels = voxelize(mesh, options); });
  std::optional<LinearOctree> octree;
  times.time("octree", [&] { octree.emplace(voxels.codes, voxels.lattice.depth); });
  times.time("inner_nodes", [&] { benchmark::DoNotOptimize(builder.finish(*octree)); });
}

void time_stages(benchmark::State& state, double voxel_size, std::size_t threads) {
  const char* const names[] = {"human_maxilla.stl", "human_mandible.stl"};
  if (!std::filesystem::exists(data_file(names[0]))) {
    state.SkipWithError("the human pair is not there");
    return;
  }
  const ScopedThreadLimit limit(threads);
  const auto file = std::filesystem::temp_directory_path() / "ist_build_bench.ist";
  StageTimes times;
  double bytes = 0;
  for (auto _ : state) {
    bytes = 0;
    for (const char* const name : names) {
      TriangleMesh mesh;
      times.time("read", [&] { mesh = read_mesh(data_file(name)); });
      run_stages(mesh, voxel_size, times);
      std::optional<SphereTree> tree;
      times.time("build", [&] { tree = build_tree(mesh, {.voxel_size = voxel_size}); });
      bytes += static_cast<double>(tree->bytes());
      times.time("pack", [&] { benchmark::DoNotOptimize(tree_to_bytes(*tree)); });
      times.time("save", [&] { write_tree(*tree, file); });
      tree.reset();
      times.time("load", [&] { tree = read_tree(file); });
    }
    times.end_round();
  }
  std::filesystem::remove(file);
  times.put(state);
  state.counters["trees_MB"] = bytes / 1e6;
}

const int kRegistered = [] {
  for (const double size : {0.0, 0.2}) {
    for (const std::size_t threads : {1u, 2u}) {
      const std::string name =
          "stages/" + std::to_string(size).substr(0, 3) + "/" + std::to_string(threads);
      benchmark::RegisterBenchmark(
          name.c_str(), [=](benchmark::State& state) { time_stages(state, size, threads); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    }
  }
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
