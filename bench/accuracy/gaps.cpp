#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "accuracy/approaches.h"
#include "accuracy/sections.h"
#include "support/latencies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

using Pose = Eigen::Isometry3d;

// mm: how far the surfaces are apart on the ways.
constexpr double kDistances[] = {0.1, 0.5, 2, 5};

struct Apart {
  Pose pose;
  double truth;  // the distance of the triangles there
};

// On each way, where the surfaces are so far apart.
std::vector<Apart> poses_at(double distance) {
  std::vector<Apart> poses;
  for (const Approach& way : approaches()) {
    double near = way.pair, far = 0;  // kApart there, which is more
    while (near - far > 1e-4) {
      const double middle = far + (near - far) / 2;
      (exact_gap(way.pose(middle)) > distance ? far : near) = middle;
    }
    poses.push_back({way.pose(far), exact_gap(way.pose(far))});
  }
  return poses;
}

const std::vector<Apart>& poses_apart(std::size_t distance) {
  static_assert(*std::max_element(std::begin(kDistances), std::end(kDistances)) < kApart);
  static std::vector<std::vector<Apart>> made(std::size(kDistances));
  if (made[distance].empty()) made[distance] = poses_at(kDistances[distance]);
  return made[distance];
}

// Asks for intervals; each must hold what triangles say.
template <class Ask>
void measure(benchmark::State& state, std::size_t distance, const Ask& ask) {
  const std::vector<Apart>& poses = poses_apart(distance);
  constexpr double kRounding = 2e-6;
  const int turns = rounds(31);
  Latencies times, widths;
  for (auto _ : state) {
    for (int turn = 0; turn < turns; ++turn) {
      for (const auto& [pose, truth] : poses) {
        const Stopwatch watch;
        const DistanceInterval gap = ask(pose);
        times.add(watch.microseconds());
        widths.add(gap.upper - gap.lower);
        if (truth < gap.lower - kRounding || truth > gap.upper + kRounding) {
          state.SkipWithError("an interval does not hold the distance");
          return;
        }
      }
    }
    state.SetIterationTime(1e-6 * times.quantile(0.5));
  }
  times.report(state);
  state.counters["width_p50"] = widths.quantile(0.5);
  state.counters["width_max"] = widths.quantile(1);
  state.counters["n"] = static_cast<double>(times.size());
  state.SetLabel(pair_name());
}

void of_voxels(benchmark::State& state, double voxel_size, SpherePolicy policy,
               std::size_t distance) {
  const auto& [fixed, moving] = trees(voxel_size);
  Query query(fixed, moving, with_policy(policy));
  measure(state, distance, [&](const Pose& pose) { return query.distance(pose, 0).distance; });
}

void of_triangles(benchmark::State& state, double voxel_size, double tolerance,
                  std::size_t distance) {
  const auto& [fixed, moving] = triangle_trees(voxel_size);
  Query query(fixed, moving);
  measure(state, distance,
          [&](const Pose& pose) { return query.distance(pose, tolerance).distance; });
}

void within(benchmark::State& state, double voxel_size, std::chrono::microseconds budget,
            std::size_t distance) {
  const auto& [fixed, moving] = trees(voxel_size);
  Query query(fixed, moving);
  std::vector<LeafPair> leaf_pairs(1 << 20);
  measure(state, distance, [&](const Pose& pose) {
    const Budget until{.deadline = Budget::Clock::now() + budget};
    return *query.leaf_pairs(pose, leaf_pairs, until).distance;
  });
}

void add(const std::string& name, const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->Unit(benchmark::kMicrosecond)
      ->UseManualTime()
      ->Iterations(1);
}

}  // namespace

void add_gaps() {
  for (std::size_t i = 0; i < std::size(kDistances); ++i) {
    for (const double size : accuracy_sizes()) {
      for (const SpherePolicy policy : kSpherePolicies) {
        add(fmt::format("gap/{:g}/{}/{:g}", size, to_string(policy), kDistances[i]),
            [=](benchmark::State& state) { of_voxels(state, size, policy, i); });
      }
    }
    for (const double tolerance : {0.1, 0.05, 0.01, 0.001}) {
      add(fmt::format("gap/0.4/exact-{:g}/{:g}", tolerance, kDistances[i]),
          [=](benchmark::State& state) { of_triangles(state, 0.4, tolerance, i); });
    }
  }
}

void add_deadlines() {
  const double size = accuracy_sizes().back() < 0.2 ? 0.2 : accuracy_sizes().back();
  for (std::size_t i = 0; i < std::size(kDistances); ++i) {
    for (const int budget : {2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000}) {
      add(fmt::format("deadline/{}/{:g}", budget, kDistances[i]), [=](benchmark::State& state) {
        state.counters["voxel_size"] = size;
        within(state, size, std::chrono::microseconds(budget), i);
      });
    }
  }
}

}  // namespace ist::bench
