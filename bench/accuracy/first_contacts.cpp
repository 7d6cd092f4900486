#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <functional>

#include "accuracy/approaches.h"
#include "accuracy/sections.h"
#include "support/latencies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

using Pose = Eigen::Isometry3d;

struct Bodies {
  double milliseconds, bytes;
};

// What it takes to have both bodies ready.
Bodies build_both(double voxel_size, SpherePolicy policy, bool triangles) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = policy;
  options.keep_triangles = triangles;
  const Stopwatch watch;
  const SphereTree upper = build_tree(upper_jaw(), options);
  const SphereTree lower = build_tree(lower_jaw(), options);
  return {watch.milliseconds(), static_cast<double>(upper.bytes() + lower.bytes())};
}

// The slowest of the closing's poses and of those where the ways first touch.
double worst_microseconds(const std::function<void(const Pose&)>& ask) {
  std::vector<Pose> poses;
  for (const double dz : kClosing) poses.push_back(closing(dz));
  for (const Approach& way : approaches()) poses.push_back(way.pose(way.contact));
  std::vector<Latencies> latencies(poses.size());
  for (int round = 0; round < rounds(101); ++round) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Stopwatch watch;
      ask(poses[i]);
      latencies[i].add(watch.microseconds());
    }
  }
  double worst = 0;
  for (Latencies& of_pose : latencies) worst = std::max(worst, of_pose.quantile(0.5));
  return worst;
}

void report(benchmark::State& state, const std::function<bool(const Pose&)>& touches,
            const std::function<void(const Pose&)>& ask, const Bodies& bodies) {
  Latencies errors;
  for (auto _ : state) {
    for (const Approach& way : approaches()) {
      const double t =
          first_touch(0, way.contact, 0.1, 1e-6, [&](double at) { return touches(way.pose(at)); });
      if (t < 0 || t > way.contact + 2e-6) {
        state.SkipWithError("what triangles meet first, voxels have missed");
        return;
      }
      errors.add(exact_gap(way.pose(t)));
    }
    const double worst = worst_microseconds(ask);
    state.SetIterationTime(1e-6 * worst);
    state.counters["worst_us"] = worst;
  }
  state.counters["error_p50"] = errors.quantile(0.5);
  state.counters["error_max"] = errors.quantile(1);
  state.counters["error_min"] = errors.quantile(0);
  state.counters["n"] = static_cast<double>(errors.size());
  state.counters["rounds"] = rounds(101);
  state.counters["build_ms"] = bodies.milliseconds;
  state.counters["MB"] = bodies.bytes / 1e6;
  state.SetLabel(pair_name());
}

void of_policy(benchmark::State& state, double voxel_size, SpherePolicy policy) {
  const auto& [fixed, moving] = exact_trees(voxel_size);
  CollisionQuery query(fixed, moving, with_policy(policy));
  std::vector<Contact> contacts(1 << 20);
  report(
      state,
      [&](const Pose& pose) { return query.collide(pose, std::span<Contact>()).contacts > 0; },
      [&](const Pose& pose) { static_cast<void>(query.collide(pose, contacts)); },
      build_both(voxel_size, policy, false));
  const QueryResult result = query.collide(closing(0), contacts);
  state.counters["resolution"] = query.resolution(result);
  state.counters["contacts"] = static_cast<double>(result.contacts);
}

// Triangles, told apart at voxels of this size: all pairs that meet, or only whether any do.
void of_triangles(benchmark::State& state, double voxel_size, bool all) {
  const auto& [fixed, moving] = exact_trees(voxel_size);
  CollisionQuery query(fixed, moving);
  std::vector<TrianglePair> pairs(1 << 16);
  const auto touches = [&](const Pose& pose) { return query.touches(pose) == Touch::kYes; };
  const auto ask = [&](const Pose& pose) {
    if (all) {
      static_cast<void>(query.collide_exact(pose, pairs));
    } else {
      benchmark::DoNotOptimize(touches(pose));
    }
  };
  report(state, touches, ask, build_both(voxel_size, SpherePolicy::kSlab, true));
  state.counters["resolution"] = 0;
}

void add(const std::string& name, const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->Unit(benchmark::kMicrosecond)
      ->UseManualTime()
      ->Iterations(1);
}

}  // namespace

void add_first_contacts() {
  for (const double size : accuracy_sizes()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      add(fmt::format("first/{:g}/{}", size, to_string(policy)),
          [=](benchmark::State& state) { of_policy(state, size, policy); });
    }
    // With larger ones leaves hold so many triangles that it takes milliseconds.
    for (const bool all : {true, false}) {
      if (size > 0.8) break;
      add(fmt::format("first/{:g}/{}", size, all ? "exact" : "touches"),
          [=](benchmark::State& state) { of_triangles(state, size, all); });
    }
  }
}

}  // namespace ist::bench
