// What the article that the method comes from has measured, measured again: voxels, octree, nodes
// and spheres of the lower jaw by voxel size, and how often a second two jaws can be asked by their
// distance. Times that a figure compares are taken in turn in one run.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "ist/query/collision_query.h"
#include "ist/query/reference.h"
#include "ist/tree/tree_statistics.h"
#include "ist/voxel/voxelizer.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/rounds.h"

namespace ist::bench {
namespace {

constexpr std::size_t kContacts = 1 << 20;
// Of the article's lower jaw, in its own units: the largest extent.
constexpr double kPublishedExtent = 73.0;

double largest_extent(const TriangleMesh& mesh) {
  Eigen::Vector3d low = mesh.vertices[0], high = low;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return (high - low).maxCoeff();
}

// Voxels and octree, without anything saved: what the article's figures 4, 5, 7 and 8 show.
void voxels(benchmark::State& state, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = SpherePolicy::kTable;
  Latencies voxel_times, octree_times;
  for (auto _ : state) {
    BuildReport report;
    const SphereTree tree = build_tree(lower_jaw(), options, &report);
    for (const BuildReport::Stage& stage : report.stages) {
      if (stage.name == std::string("voxels")) voxel_times.add(1e3 * stage.milliseconds);
      if (stage.name == std::string("octree")) octree_times.add(1e3 * stage.milliseconds);
    }
    state.counters["leaves"] = tree.octree().leaf_count();
    state.counters["nodes"] = static_cast<double>(tree.octree().node_count());
    state.counters["cells"] = tree.lattice().cells;
    state.counters["depth"] = tree.depth();
    state.counters["MB"] = static_cast<double>(tree.bytes()) / 1e6;
  }
  state.counters["voxels_ms"] = 1e-3 * voxel_times.quantile(0.5);
  state.counters["octree_ms"] = 1e-3 * octree_times.quantile(0.5);
  state.counters["n"] = static_cast<double>(voxel_times.size());
  state.counters["extent"] = largest_extent(lower_jaw());
  state.counters["triangles"] = static_cast<double>(lower_jaw().triangles.size());
  state.SetLabel(pair_name());
}

void add_voxels(const std::string& name, double voxel_size) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) { voxels(state, voxel_size); })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

// Figure 9: volume of the spheres of a level, and the time to make them; the least of a few, for
// nothing but the processor can make it longer.
void levels(benchmark::State& state, double voxel_size, SpherePolicy policy, std::size_t level) {
  const SphereTree& tree = trees(voxel_size).second;
  const int times = rounds(30);
  double microseconds = 0;
  LevelStatistics here{};
  for (auto _ : state) {
    for (int i = 0; i < times; ++i) {
      // Of the whole tree each time, so that a level finds the caches as a traversal leaves them.
      const std::vector<LevelStatistics> all = level_statistics(tree);
      if (level >= all.size()) {
        state.SkipWithError("there is no such level");
        return;
      }
      here = all[level];
      const double made = 1e3 * here.spheres[static_cast<std::size_t>(policy)].milliseconds;
      microseconds = i == 0 ? made : std::min(microseconds, made);
    }
    state.SetIterationTime(1e-6 * microseconds);
  }
  const double volume = here.spheres[static_cast<std::size_t>(policy)].volume;
  state.counters["nodes"] = here.nodes;
  state.counters["volume"] = volume;
  state.counters["leaf_balls"] = volume / unit_ball_volume(voxel_size);
  state.counters["make_us"] = microseconds;
  state.counters["n"] = times;
  state.SetLabel(pair_name());
}

void add_levels(const std::string& name, double voxel_size) {
  const int depth = lattice_of(lower_jaw(), voxel_size).depth;
  for (const SpherePolicy policy : kSpherePolicies) {
    for (int level = 0; level <= depth; ++level) {
      benchmark::RegisterBenchmark(
          fmt::format("levels/{}/{}/{}", name, to_string(policy), level).c_str(),
          [=](benchmark::State& state) {
            levels(state, voxel_size, policy, static_cast<std::size_t>(level));
          })
          ->Unit(benchmark::kMicrosecond)
          ->UseManualTime()
          ->Iterations(1);
    }
  }
}

template <class Query, class... Options>
Way way(const std::string& name, int times, double voxel_size, const Options&... options) {
  const auto& [fixed, moving] = trees(voxel_size);
  const auto query = std::make_shared<Query>(fixed, moving, options...);
  const auto contacts = std::make_shared<std::vector<Contact>>(kContacts);
  return {name, [=](const Eigen::Isometry3d& pose) { return query->collide(pose, *contacts); },
          times};
}

Place at(double distance) { return {fmt::format("{:g}", distance), closing(-distance)}; }

// The article's first proposal: spheres that are saved, against spheres made at each visit.
void add_saved(double voxel_size) {
  std::vector<std::string> names;
  for (const SpherePolicy policy : kSpherePolicies) {
    for (const char* source : {"on_the_fly", "saved"}) {
      names.push_back(fmt::format("{}/{}", to_string(policy), source));
    }
  }
  Rounds::add(
      fmt::format("saved/{:g}", voxel_size), names, {at(0), at(1.5)},
      [=] {
        std::vector<Way> ways;
        for (std::size_t i = 0; i < names.size(); ++i) {
          ways.push_back(
              way<ReferenceQuery>(names[i], 1, voxel_size, kSpherePolicies[i / 2],
                                  i % 2 == 0 ? SphereSource::kOnTheFly : SphereSource::kSaved));
        }
        return ways;
      },
      rounds(31),
      [=](benchmark::State& state, const QueryResult&) {
        const auto& [fixed, moving] = trees(voxel_size);
        const auto nodes =
            static_cast<double>(fixed.octree().node_count() + moving.octree().node_count());
        state.counters["saved_MB"] = sizeof(Ball) * nodes / 1e6;
        state.counters["octree_MB"] =
            static_cast<double>(fixed.octree().bytes() + moving.octree().bytes()) / 1e6;
      });
}

// Figure 10: by distance, policy and engine.
void add_rates(double voxel_size) {
  std::vector<Place> places;
  for (const double distance : {0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.5, 10.0, 15.0, 20.0,
                                25.0, 30.0, 40.0, 50.0}) {
    places.push_back(at(distance));
  }
  std::vector<std::string> names;
  for (const char* engine : {"reference", "fast"}) {
    for (const SpherePolicy policy : kSpherePolicies) {
      names.push_back(fmt::format("{}/{}", engine, to_string(policy)));
    }
  }
  Rounds::add(
      fmt::format("rate/{:g}", voxel_size), names, places,
      [=] {
        std::vector<Way> ways;
        for (const SpherePolicy policy : kSpherePolicies) {
          ways.push_back(way<ReferenceQuery>(names[ways.size()], 1, voxel_size, policy));
        }
        for (const SpherePolicy policy : kSpherePolicies) {
          CollisionOptions options;
          options.policy = policy;
          ways.push_back(way<CollisionQuery>(names[ways.size()], 5, voxel_size, options));
        }
        return ways;
      },
      rounds(voxel_size < 0.5 ? 31 : 101));
}

const int kRegistered = [] {
  const double extent = largest_extent(lower_jaw());
  for (const double size : {10.0, 5.0, 2.0, 1.0, 0.8, 0.5, 0.4, 0.3, 0.2, 0.1, 0.05}) {
    if (size >= 0.2 || !quick()) add_voxels(fmt::format("voxels/{:g}", size), size);
  }
  // As many voxels along the jaw as the article has.
  for (const double size : {10.0, 5.0, 1.0}) {
    add_voxels(fmt::format("scaled/{:g}", size), size * extent / kPublishedExtent);
  }
  // Round the powers of two, which the article's octree is raised to.
  for (const int cells : {96,  112, 120, 126, 127, 128, 129, 130, 136, 160,
                          192, 224, 240, 254, 255, 256, 257, 258, 272, 320}) {
    if (cells % 16 == 0 || !quick()) {
      add_voxels(fmt::format("octree/{}", cells), extent / cells * (1 + 1e-12));
    }
  }
  add_levels("scaled1", extent / kPublishedExtent);
  if (!quick()) add_levels("0.2", 0.2);
  for (const double size : {0.8, 0.2}) {
    add_saved(size);
    add_rates(size);
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
