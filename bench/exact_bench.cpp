// Questions about triangles: afresh, with the triangles that met or were nearest last, and with two
// workers; and the clusters that answer them, made by one thread.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <vector>

#include "ist/base/parallel.h"
#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/query/query.h"
#include "support/bodies.h"

namespace ist::bench {
namespace {

constexpr double kVoxelSize = 0.4;  // which does not matter
constexpr double kTolerance = 0.05;

Query query_of(int workers) {
  const auto& [fixed, moving] = triangle_trees(kVoxelSize);
  return Query(fixed, moving, {.workers = workers, .period = {}});
}

// Asks again and again at one pose; `fresh` forgets before.
template <class Ask>
void measure(benchmark::State& state, bool fresh, int workers, Ask ask) {
  Query query = query_of(workers);
  std::uint64_t tests = 0;
  for (auto _ : state) {
    if (fresh) query.forget();
    tests = ask(query);
  }
  state.counters["tests"] = static_cast<double>(tests);
  state.SetLabel(pair_name());
}

template <class Ask>
void add(const char* question, const char* how, bool fresh, int workers, Ask ask) {
  for (const double dz : kClosing) {
    const Eigen::Isometry3d pose = closing(dz);
    benchmark::RegisterBenchmark(fmt::format("exact/{}/{}/{}", question, how, dz).c_str(),
                                 [=](benchmark::State& state) {
                                   measure(state, fresh, workers,
                                           [&](Query& query) { return ask(query, pose); });
                                 })
        ->Unit(benchmark::kMicrosecond)
        ->UseRealTime();
  }
}

void add_clusters(const char* name, const TriangleMesh& (*mesh_of)()) {
  benchmark::RegisterBenchmark(fmt::format("exact/clusters/{}", name).c_str(),
                               [=](benchmark::State& state) {
                                 const TriangleMesh& mesh = mesh_of();
                                 const ScopedThreadLimit one(1);
                                 std::size_t bytes = 0;
                                 for (auto _ : state)
                                   bytes = TriangleClusters(mesh, Eigen::Vector3d::Zero()).bytes();
                                 const auto triangles = static_cast<double>(mesh.triangles.size());
                                 state.counters["triangles"] = triangles;
                                 state.counters["bytes_a_triangle"] =
                                     static_cast<double>(bytes) / triangles;
                                 state.SetLabel(pair_name());
                               })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

const bool kAdded = [] {
  const auto intersects = [](Query& query, const Eigen::Isometry3d& pose) {
    return query.intersects(pose).sphere_tests;
  };
  const auto distance = [](Query& query, const Eigen::Isometry3d& pose) {
    return query.distance(pose, kTolerance).sphere_tests;
  };
  const auto pairs = [](Query& query, const Eigen::Isometry3d& pose) {
    static std::vector<TrianglePair> found(1 << 16);
    return query.triangle_pairs(pose, found).sphere_tests;
  };
  add("intersects", "fresh", true, 1, intersects);
  add("intersects", "again", false, 1, intersects);
  add("distance", "fresh", true, 1, distance);
  add("distance", "again", false, 1, distance);
  add("pairs", "one_worker", true, 1, pairs);
  add("pairs", "two_workers", true, 2, pairs);
  add_clusters("upper", &upper_jaw);
  add_clusters("lower", &lower_jaw);
  return true;
}();

}  // namespace
}  // namespace ist::bench
