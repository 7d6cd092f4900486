#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <memory>
#include <vector>

#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/voxelizer.h"
#include "seed/sections.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/latencies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

// Makes, or reads, the sphere of each node of a level as a query does, whose cubes' centres are
// known from the level above.
double sum_of_spheres(const SphereTree& tree, SpherePolicy policy, int level,
                      const std::vector<Eigen::Vector3d>& centres) {
  double sum = 0;
  if (is_implicit(policy)) {
    for (std::uint32_t node = 0; node < centres.size(); ++node) {
      const Ball ball = voxels_of(tree).ball(policy, level, node, centres[node]);
      sum += ball.centre.sum() + ball.radius;
    }
    return sum;
  }
  const auto parents = static_cast<std::uint32_t>(voxels_of(tree).balls(level).size());
  for (std::uint32_t parent = 0; parent < parents; ++parent) {
    const int children = voxels_of(tree).octree.child_count(level + 1, parent);
    for (int slot = 0; slot < children; ++slot) {
      const Ball ball = voxels_of(tree).saved_ball(level, parent, slot);
      sum += ball.centre.sum() + ball.radius;
      if (policy == SpherePolicy::kSlab)
        sum += voxels_of(tree).saved_slab(level, parent, slot).half;
    }
  }
  return sum;
}

// Figure 9: volume of the spheres of a level, and the time to make them; the least of many, for
// nothing but the machine can make it longer. All policies take turns.
class Level {
 public:
  Level(double voxel_size, int level) : voxel_size_(voxel_size), level_(level) {}

  void report(benchmark::State& state, SpherePolicy policy) {
    const auto at = static_cast<std::size_t>(policy);
    for (auto _ : state) {
      if (times_.empty()) measure();
      state.SetIterationTime(1e-6 * times_[at].quantile(0));
    }
    state.counters["nodes"] = voxels_of(trees(voxel_size_).second).octree.node_count(level_);
    state.counters["volume"] = volumes_[at];
    state.counters["leaf_balls"] = volumes_[at] / unit_ball_volume(voxel_size_);
    state.counters["make_us"] = times_[at].quantile(0);
    state.counters["n"] = static_cast<double>(times_[at].size());
    state.SetLabel(pair_name());
  }

 private:
  void measure() {
    const SphereTree& tree = trees(voxel_size_).second;
    std::vector<Eigen::Vector3d> centres;
    for (const std::uint64_t code : voxels_of(tree).octree.codes(level_)) {
      centres.push_back(cube_centre(voxels_of(tree).lattice, level_, code));
    }
    const LevelStatistics statistics = level_statistics(tree)[static_cast<std::size_t>(level_)];
    for (const LevelSpheres& spheres : statistics.spheres) volumes_.push_back(spheres.volume);
    times_.resize(kSpherePolicies.size());
    for (int round = 0; round < rounds(300); ++round) {
      for (const SpherePolicy policy : kSpherePolicies) {
        const Stopwatch watch;
        benchmark::DoNotOptimize(sum_of_spheres(tree, policy, level_, centres));
        times_[static_cast<std::size_t>(policy)].add(watch.microseconds());
      }
    }
  }

  double voxel_size_;
  int level_;
  std::vector<double> volumes_;   // by policy
  std::vector<Latencies> times_;  // by policy
};

}  // namespace

void add_levels() {
  const double voxel_size = published_unit();
  const int depth = lattice_of(lower_jaw(), voxel_size).depth;
  for (int at = 0; at <= depth; ++at) {
    const auto level = std::make_shared<Level>(voxel_size, at);
    for (const SpherePolicy policy : kSpherePolicies) {
      benchmark::RegisterBenchmark(fmt::format("levels/{}/{}", to_string(policy), at).c_str(),
                                   [=](benchmark::State& state) { level->report(state, policy); })
          ->Unit(benchmark::kMicrosecond)
          ->UseManualTime()
          ->Iterations(1);
    }
  }
}

}  // namespace ist::bench
