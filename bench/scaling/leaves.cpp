// Both jaws, finer and finer: a query's time and memory against their leaves. The finest pair is
// one of which a line through two others says that it takes most of 16 GiB.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "ist/base/error.h"
#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"
#include "scaling/asked.h"
#include "scaling/series.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/peak_memory.h"

namespace ist::bench {
namespace {

// The memory of both jaws in voxels of a size: to be built one after the other, and to be held.
// Megabytes are 10^6 bytes.
struct Footprint {
  double leaves;    ///< of both trees
  double trees_mb;  ///< that they keep
  double query_mb;  ///< that a query of one worker reserves
  double peak_mb;   ///< the most in use while they were built, above what was before
  double build_s;   ///< wall time
};

// Bytes that one tree's building may take here (BuildOptions::max_memory).
inline constexpr std::uint64_t kMaxMemory = std::uint64_t{16} << 30;

using Key = std::pair<SpherePolicy, double>;
using Trees = std::pair<SphereTree, SphereTree>;

struct Kept {
  Key key;
  Trees trees;
};

std::unique_ptr<Kept>& kept() {
  static std::unique_ptr<Kept> last;
  return last;
}

std::map<Key, Footprint>& measured() {
  static std::map<Key, Footprint> footprints;
  return footprints;
}

SphereTree build_large(const TriangleMesh& mesh, const Key& key) {
  BuildOptions options;
  options.spheres = key.first;
  options.voxel_size = key.second;
  options.max_memory = kMaxMemory;
  return build_tree(mesh, options);
}

double megabytes(std::uint64_t bytes) { return 1e-6 * static_cast<double>(bytes); }

void build_jaws(const Key& key) {
  const TriangleMesh &upper = upper_jaw(), &lower = lower_jaw();  // read before the clock runs
  kept().reset();
  reset_peak_memory();
  const double before = peak_memory_mb();
  const auto begin = std::chrono::steady_clock::now();
  // One after the other, as whoever has no more memory than that would.
  SphereTree fixed = build_large(upper, key);
  SphereTree moving = build_large(lower, key);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  const double peak = peak_memory_mb() - before;
  kept() = std::make_unique<Kept>(Kept{key, {std::move(fixed), std::move(moving)}});
  const auto& [a, b] = kept()->trees;
  measured()[key] = {static_cast<double>(a.leaf_count()) + b.leaf_count(),
                     megabytes(a.bytes() + b.bytes()), megabytes(Query(a, b).bytes()), peak,
                     time.count()};
}

// Both jaws; the last pair that was asked for is kept, and no other.
const Trees& jaws(SpherePolicy policy, double voxel_size) {
  const Key key{policy, voxel_size};
  if (kept() == nullptr || kept()->key != key) build_jaws(key);
  return kept()->trees;
}

void forget_jaws() { kept().reset(); }

// Measured when jaws() first builds them. Throws what build_tree does.
const Footprint& footprint(SpherePolicy policy, double voxel_size) {
  const Key key{policy, voxel_size};
  if (!measured().contains(key)) build_jaws(key);
  return measured().at(key);
}

constexpr double kPoses[] = {0, -1.5};
// Of the limit: build_tree() refuses by an estimate made beforehand, which is larger than the peak.
constexpr double kPartOfLimit = 0.75;
constexpr double kLimitMb = 1e-6 * static_cast<double>(kMaxMemory);

std::vector<double> voxel_sizes() {
  if (quick()) return {3.2, 1.6, 0.8, 0.4};
  return {3.2, 1.6, 0.8, 0.4, 0.2, 0.1, 0.05};
}

void tell(benchmark::State& state, const Footprint& footprint) {
  state.counters["leaves"] = footprint.leaves;
  state.counters["trees_MB"] = footprint.trees_mb;
  state.counters["query_MB"] = footprint.query_mb;
  state.counters["peak_MB"] = footprint.peak_mb;
  state.counters["build_s"] = footprint.build_s;
}

void memory(benchmark::State& state, SpherePolicy policy, double voxel_size) {
  const Footprint& found = footprint(policy, voxel_size);
  for (auto _ : state) state.SetIterationTime(found.build_s);
  tell(state, found);
  state.SetLabel(pair_name());
}

std::vector<Asked> ask_jaws(SpherePolicy policy, double voxel_size, int rounds) {
  std::vector<Eigen::Isometry3d> poses;
  for (const double dz : kPoses) poses.push_back(closing(dz));
  return ask(jaws(policy, voxel_size), poses, {rounds});
}

// Of both jaws, by the surface: so a line over 1 / size² through the two finest that were built.
double size_that_takes(double megabytes, SpherePolicy policy) {
  const std::vector<double> sizes = voxel_sizes();
  const auto over = [](double size) { return 1 / (size * size); };
  const double fine = sizes.back(), coarse = sizes[sizes.size() - 2];
  const double of_fine = footprint(policy, fine).peak_mb;
  const double slope = (of_fine - footprint(policy, coarse).peak_mb) / (over(fine) - over(coarse));
  return 1 / std::sqrt(over(fine) + (megabytes - of_fine) / slope);
}

double available_mb() {
  std::ifstream info("/proc/meminfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("MemAvailable:")) return std::stod(line.substr(13)) * 1024 / 1e6;
  }
  return 0;
}

// Why there is no largest pair; empty where there is one.
std::string left_out() {
  if (quick()) return "not built: it takes minutes";
  return available_mb() > kLimitMb ? "" : "not built: less than 16 GiB are free";
}

// The pair, built; else false, and its label says why not.
bool largest_is_built(benchmark::State& state, SpherePolicy policy, double& voxel_size) {
  std::string why_not = left_out();
  if (why_not.empty()) {
    voxel_size = size_that_takes(kPartOfLimit * kLimitMb, policy);
    try {
      static_cast<void>(footprint(policy, voxel_size));
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kMemoryLimit) throw;
      why_not = fmt::format("not built: {}", error.what());
    }
  }
  state.SetLabel(why_not.empty() ? pair_name() : why_not);
  return why_not.empty();
}

void largest(benchmark::State& state, SpherePolicy policy) {
  double voxel_size = 0;
  const bool built = largest_is_built(state, policy, voxel_size);
  const double seconds = built ? footprint(policy, voxel_size).build_s : 0;
  for (auto _ : state) state.SetIterationTime(seconds);
  state.counters["built"] = built;
  state.counters["voxel_size"] = voxel_size;
  state.counters["part_of_limit"] = kPartOfLimit;
  if (!built) return;
  tell(state, footprint(policy, voxel_size));
  Asked closed = ask_jaws(policy, voxel_size, 5).front();
  forget_jaws();
  tell(state, closed);
}

template <class Run>
void add(const std::string& name, const Run& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->Unit(benchmark::kMicrosecond)
      ->UseManualTime()
      ->Iterations(1);
}

void add_memory(SpherePolicy policy, double voxel_size) {
  add(fmt::format("memory/{}/{}", to_string(policy), voxel_size),
      [=](benchmark::State& state) { memory(state, policy, voxel_size); });
}

}  // namespace

void add_leaves() {
  for (const double size : voxel_sizes()) {
    add_memory(SpherePolicy::kSlab, size);
    const auto series =
        std::make_shared<Series>([=] { return ask_jaws(SpherePolicy::kSlab, size, rounds(500)); });
    for (std::size_t pose = 0; pose < std::size(kPoses); ++pose) {
      add(fmt::format("leaves/{}/{}", size, kPoses[pose]), [=](benchmark::State& state) {
        series->report(state, pose);
        state.counters["leaves"] = footprint(SpherePolicy::kSlab, size).leaves;
        state.SetLabel(pair_name());
      });
    }
  }
  for (const double size : voxel_sizes()) add_memory(SpherePolicy::kTable, size);
  add("largest/table", [](benchmark::State& state) { largest(state, SpherePolicy::kTable); });
}

}  // namespace ist::bench
