// Contacts of a closing: the time of the search, of the sums over its leaf pairs, and of points.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "ist/query/query.h"
#include "support/bodies.h"

namespace ist::bench {
namespace {

constexpr std::size_t kSearchAlone = ~std::size_t{0};

void contacts(benchmark::State& state, double voxel_size, SpherePolicy policy, std::size_t most,
              double dz) {
  const auto& [fixed, moving] = trees(voxel_size);
  QueryOptions options;
  options.policy = policy;
  Query query(fixed, moving, options);
  ManifoldOptions manifold;
  manifold.points = most == kSearchAlone ? 0 : most;
  manifold.margin = 2;  // every leaf pair counts
  ContactManifold points(fixed, moving, policy, manifold);
  const Eigen::Isometry3d pose = closing(dz);
  const auto pairs = static_cast<double>(query.contacts(pose, points).leaf_pairs);
  if ((points.sums().weight > 0) != (points.sums().pairs > 0)) {
    state.SkipWithError("pairs that weigh have no weight");
    return;
  }
  if (most == kSearchAlone) {
    std::vector<LeafPair> leaf_pairs(1 << 20);
    for (auto _ : state) benchmark::DoNotOptimize(query.leaf_pairs(pose, leaf_pairs));
  } else {
    for (auto _ : state) benchmark::DoNotOptimize(query.contacts(pose, points));
  }
  state.counters["pairs"] = pairs;
  state.counters["points"] = static_cast<double>(points.points().size());
  state.counters["MB"] = static_cast<double>(points.bytes()) / 1e6;
  if (pairs > 0) {
    state.counters["per_pair"] = benchmark::Counter(
        pairs, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  }
  state.SetLabel(pair_name());
}

const int kRegistered = [] {
  for (const double size : {0.8, 0.2}) {
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      for (const std::size_t most : {kSearchAlone, std::size_t{0}, ManifoldOptions{}.points}) {
        for (const double dz : kClosing) {
          const std::string name = "contact_points/" + std::to_string(size).substr(0, 3) + "/" +
                                   std::string(to_string(policy)) + "/" +
                                   (most == kSearchAlone ? "search" : std::to_string(most)) + "/" +
                                   std::to_string(dz).substr(0, 4);
          benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
            contacts(state, size, policy, most, dz);
          })->Unit(benchmark::kMicrosecond);
        }
      }
    }
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
