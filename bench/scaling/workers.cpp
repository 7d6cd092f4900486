// One worker and two, paced at 1 kHz as a servo loop asks and back to back, and how often the
// second one took part.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <memory>
#include <vector>

#include "scaling/asked.h"
#include "scaling/series.h"
#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {
namespace {

constexpr double kVoxelSize = 0.2;

std::vector<Asked> ask_closing(int workers, bool paced) {
  const std::chrono::nanoseconds period(paced ? 1'000'000 : 0);
  std::vector<Eigen::Isometry3d> poses;
  for (const double dz : kClosing) poses.push_back(closing(dz));
  return ask(triangle_trees(kVoxelSize), poses, {rounds(1000), workers, period});
}

void report(benchmark::State& state, Series& series, std::size_t pose) {
  const Asked& asked = series.report(state, pose);
  const auto rounds = static_cast<double>(asked.rounds);
  state.counters["voxel_size"] = kVoxelSize;
  state.counters["worth"] = static_cast<double>(asked.worth) / rounds;
  state.counters["shared"] = static_cast<double>(asked.shared) / rounds;
  state.SetLabel(pair_name());
}

}  // namespace

void add_workers() {
  for (const int workers : {1, 2}) {
    for (const bool paced : {false, true}) {
      const auto series = std::make_shared<Series>([=] { return ask_closing(workers, paced); });
      for (std::size_t pose = 0; pose < std::size(kClosing); ++pose) {
        benchmark::RegisterBenchmark(
            fmt::format("workers/{}/{}/{}", workers, paced ? "paced" : "row", kClosing[pose])
                .c_str(),
            [=](benchmark::State& state) { report(state, *series, pose); })
            ->Unit(benchmark::kMicrosecond)
            ->UseManualTime()
            ->Iterations(1);
      }
    }
  }
}

}  // namespace ist::bench
