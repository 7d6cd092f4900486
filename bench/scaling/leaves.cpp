// Both jaws, finer and finer: a query's time and memory against their leaves. The finest pair is
// one of which a line through two others says that it takes most of 16 GiB.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "ist/base/error.h"
#include "scaling/asked.h"
#include "scaling/footprint.h"
#include "scaling/series.h"
#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {
namespace {

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
