// Contact points of a closing: what reducing every leaf pair costs, beside finding them.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/query.h"
#include "support/bodies.h"

namespace ist::bench {
namespace {

void reduce(benchmark::State& state, double voxel_size, SpherePolicy policy, std::size_t most,
            double dz) {
  const auto& [fixed, moving] = trees(voxel_size);
  QueryOptions options;
  options.policy = policy;
  Query query(fixed, moving, options);
  ContactManifold points(fixed, moving, policy, {most, ManifoldOptions{}.max_leaves});
  const Eigen::Isometry3d pose = closing(dz);
  std::vector<LeafPair> leaf_pairs(1 << 20);
  const std::uint64_t count = query.leaf_pairs(pose, leaf_pairs).leaf_pairs;
  if (count > leaf_pairs.size()) {
    state.SkipWithError("there are more contacts than there is room for");
    return;
  }
  leaf_pairs.resize(count);
  static_cast<void>(query.contacts(pose, points));
  const ContactSums wanted = points.sums();
  static_cast<void>(points.reducer().begin(pose));
  points.reducer().take(leaf_pairs);
  points.reducer().finish();
  if (points.sums().weight != wanted.weight || (wanted.weight > 0) != (wanted.pairs > 0)) {
    state.SkipWithError("the list and the stream give different sums");
    return;
  }
  for (auto _ : state) {
    static_cast<void>(points.reducer().begin(pose));
    points.reducer().take(leaf_pairs);
    points.reducer().finish();
  }
  const auto pairs = static_cast<double>(count);
  state.counters["pairs"] = pairs;
  state.counters["points"] = static_cast<double>(points.points().size());
  state.counters["MB"] = static_cast<double>(points.bytes()) / 1e6;
  if (count > 0) {
    state.counters["per_pair"] = benchmark::Counter(
        pairs, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  }
  state.SetLabel(pair_name());
}

const int kRegistered = [] {
  for (const double size : {0.8, 0.2}) {
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      for (const std::size_t most : {std::size_t{0}, ManifoldOptions{}.points}) {
        for (const double dz : kClosing) {
          const std::string name = "contact_points/" + std::to_string(size).substr(0, 3) + "/" +
                                   std::string(to_string(policy)) + "/" + std::to_string(most) +
                                   "/" + std::to_string(dz).substr(0, 4);
          benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
            reduce(state, size, policy, most, dz);
          })->Unit(benchmark::kMicrosecond);
        }
      }
    }
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
