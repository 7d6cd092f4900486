// Two saved trees, read, verified and asked for the first time; the files are in the page cache.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <string>
#include <vector>

#include "ist/query/reference/reference_query.h"
#include "ist/tree/sphere_tree.h"
#include "support/bodies.h"

namespace ist::bench {
namespace {

void load_and_ask(benchmark::State& state, SpherePolicy policy) {
  constexpr double kVoxelSize = 0.2;
  const auto folder = std::filesystem::temp_directory_path();
  const auto upper = folder / "ist_load_bench_upper.ist",
             lower = folder / "ist_load_bench_lower.ist";
  double bytes = 0;
  bytes += static_cast<double>(write_tree(build(upper_jaw(), kVoxelSize, policy), upper));
  bytes += static_cast<double>(write_tree(build(lower_jaw(), kVoxelSize, policy), lower));
  std::vector<LeafPair> leaf_pairs(1 << 20);
  for (auto _ : state) {
    const SphereTree fixed = read_tree(upper), moving = read_tree(lower);
    ReferenceQuery query(fixed, moving, policy);
    benchmark::DoNotOptimize(query.leaf_pairs(closing(-1.5), leaf_pairs));
  }
  state.counters["file_MB"] = bytes / 1e6;
  state.SetLabel(pair_name());
  std::filesystem::remove(upper);
  std::filesystem::remove(lower);
}

BENCHMARK_CAPTURE(load_and_ask, table, SpherePolicy::kTable)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(load_and_ask, tight, SpherePolicy::kTight)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(load_and_ask, slab, SpherePolicy::kSlab)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace ist::bench
