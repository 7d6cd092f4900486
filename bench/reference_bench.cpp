// The published query along a closing, by policy: spheres made on the fly against spheres saved.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "ist/query/reference/reference_query.h"
#include "ist/tree/tree_parts.h"
#include "support/bodies.h"

namespace ist::bench {
namespace {

void leaf_pairs(benchmark::State& state, double voxel_size, SpherePolicy policy,
                SphereSource source, double dz) {
  const auto& [fixed, moving] = trees(voxel_size);
  ReferenceQuery query(fixed, moving, policy, source);
  std::vector<LeafPair> leaf_pairs(1 << 20);
  const Eigen::Isometry3d pose = closing(dz);
  QueryResult result;
  for (auto _ : state) benchmark::DoNotOptimize(result = query.leaf_pairs(pose, leaf_pairs));
  const auto tests = static_cast<double>(result.sphere_tests);
  state.counters["contacts"] = static_cast<double>(result.leaf_pairs);
  state.counters["sphere_tests"] = tests;
  state.counters["per_test"] = benchmark::Counter(
      tests, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  if (source == SphereSource::kSaved) {
    state.counters["saved_MB"] = static_cast<double>(sizeof(Ball)) / 1e6 *
                                 static_cast<double>(voxels_of(fixed).octree.node_count() +
                                                     voxels_of(moving).octree.node_count());
  }
  state.SetLabel(pair_name());
}

const int kRegistered = [] {
  for (const double size : {0.8, 0.2}) {
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const auto source : {SphereSource::kOnTheFly, SphereSource::kSaved}) {
        for (const double dz : kClosing) {
          const std::string name = "reference/" + std::to_string(size).substr(0, 3) + "/" +
                                   std::string(to_string(policy)) +
                                   (source == SphereSource::kSaved ? "/saved/" : "/on_the_fly/") +
                                   std::to_string(dz).substr(0, 4);
          benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
            leaf_pairs(state, size, policy, source, dz);
          })->Unit(benchmark::kMicrosecond);
        }
      }
    }
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
