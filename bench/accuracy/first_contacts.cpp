#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <string>

#include "accuracy/approaches.h"
#include "accuracy/sections.h"
#include "support/latencies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

using Pose = Eigen::Isometry3d;

// mm: answers about triangles hang on no voxels, so they are asked of the trees of one size.
constexpr double kOfTriangles = 0.4;

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

// A way to find contacts.
struct Finder {
  std::string name;
  std::function<bool(const Pose&)> intersects;  // whether there are any
  std::function<void(const Pose&)> ask;         // what is timed
  SpherePolicy policy;
  bool triangles;
  double resolution;
};

Finder of_policy(double voxel_size, SpherePolicy policy) {
  const auto& [fixed, moving] = triangle_trees(voxel_size);
  const auto query = std::make_shared<Query>(fixed, moving, with_policy(policy));
  const auto leaf_pairs = std::make_shared<std::vector<LeafPair>>(1 << 20);
  return {std::string(to_string(policy)),
          [=](const Pose& pose) {
            return query->leaf_pairs(pose, std::span<LeafPair>()).leaf_pairs > 0;
          },
          [=](const Pose& pose) { static_cast<void>(query->leaf_pairs(pose, *leaf_pairs)); },
          policy,
          false,
          query->leaf_pairs(closing(0), *leaf_pairs).resolution};
}

// Triangles, in trees with voxels of this size: all pairs that meet, or only whether any do.
Finder of_triangles(double voxel_size, bool all) {
  const auto& [fixed, moving] = triangle_trees(voxel_size);
  const auto query = std::make_shared<Query>(fixed, moving);
  const auto pairs = std::make_shared<std::vector<TrianglePair>>(1 << 16);
  const auto intersects = [=](const Pose& pose) {
    return query->intersects(pose).answer == ist::Answer::kYes;
  };
  const auto all_pairs = [=](const Pose& pose) {
    static_cast<void>(query->triangle_pairs(pose, *pairs));
  };
  const auto any = [=](const Pose& pose) { benchmark::DoNotOptimize(intersects(pose)); };
  return {all ? "exact" : "touches",
          intersects,
          all ? std::function<void(const Pose&)>(all_pairs) : any,
          SpherePolicy::kSlab,
          true,
          2e-6};  // what the exact contact is known to
}

// All ways to find contacts at one voxel size, timed in turns.
class Size {
 public:
  explicit Size(double voxel_size) : voxel_size_(voxel_size) {
    for (const SpherePolicy policy : kSpherePolicies) names_.emplace_back(to_string(policy));
    if (voxel_size == kOfTriangles) names_.insert(names_.end(), {"exact", "touches"});
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  void report(benchmark::State& state, std::size_t at) {
    if (finders_.empty()) measure();
    const Finder& finder = finders_[at];
    Latencies errors;
    for (auto _ : state) {
      for (const Approach& way : approaches()) {
        const double t = first_touch(0, way.pair, kStep, 1e-6, [&](double place) {
          return finder.intersects(way.pose(place));
        });
        if (t < 0 || t > way.pair + 2e-6) {
          state.SkipWithError("what triangles meet first, voxels have missed");
          return;
        }
        errors.add(exact_gap(way.pose(t)));
      }
      if (errors.quantile(1) > finder.resolution) {
        state.SkipWithError("an error is larger than the bound that was guaranteed");
        return;
      }
      state.SetIterationTime(1e-6 * slowest_[at].quantile(0.5));
    }
    slowest_[at].report(state);
    const Bodies bodies = build_both(voxel_size_, finder.policy, finder.triangles);
    state.counters["error_p50"] = errors.quantile(0.5);
    state.counters["error_max"] = errors.quantile(1);
    state.counters["resolution"] = finder.triangles ? 0 : finder.resolution;
    constexpr double kDegrees = 57.29577951308232;
    state.counters["turned_degrees"] = 2 * kDegrees * std::atan(kHalfTurn);
    state.counters["inclined_degrees"] = kDegrees * std::atan(kBeside);
    state.counters["closing_poses"] = static_cast<double>(std::size(kClosing));
    state.counters["n"] = static_cast<double>(errors.size());
    state.counters["rounds"] = static_cast<double>(slowest_[at].size());
    state.counters["build_ms"] = bodies.milliseconds;
    state.counters["MB"] = bodies.bytes / 1e6;
    state.SetLabel(pair_name());
  }

 private:
  void measure() {
    for (const SpherePolicy policy : kSpherePolicies) {
      finders_.push_back(of_policy(voxel_size_, policy));
    }
    if (names_.size() > finders_.size()) {
      for (const bool all : {true, false}) finders_.push_back(of_triangles(voxel_size_, all));
    }
    std::vector<Pose> poses;
    for (const double dz : kClosing) poses.push_back(closing(dz));
    for (const Approach& way : approaches()) poses.push_back(way.pose(way.pair));
    std::vector<std::vector<Latencies>> times(finders_.size(),
                                              std::vector<Latencies>(poses.size()));
    for (int round = 0; round < rounds(101); ++round) {
      for (std::size_t i = 0; i < finders_.size(); ++i) {
        // Not timed: the last one has left its own trees in the caches.
        for (const Pose& pose : poses) finders_[i].ask(pose);
        for (std::size_t pose = 0; pose < poses.size(); ++pose) {
          const Stopwatch watch;
          finders_[i].ask(poses[pose]);
          times[i][pose].add(watch.microseconds());
        }
      }
    }
    for (std::vector<Latencies>& by_pose : times) {
      slowest_.push_back(*std::max_element(
          by_pose.begin(), by_pose.end(),
          [](Latencies& a, Latencies& b) { return a.quantile(0.5) < b.quantile(0.5); }));
    }
  }

  double voxel_size_;
  std::vector<std::string> names_;
  std::vector<Finder> finders_;
  std::vector<Latencies>
      slowest_;  // of each way to find, those of the pose with the largest median
};

}  // namespace

void add_first_contacts() {
  for (const double size : accuracy_sizes()) {
    const auto of_size = std::make_shared<Size>(size);
    for (std::size_t i = 0; i < of_size->names().size(); ++i) {
      benchmark::RegisterBenchmark(fmt::format("first/{:g}/{}", size, of_size->names()[i]).c_str(),
                                   [=](benchmark::State& state) { of_size->report(state, i); })
          ->Unit(benchmark::kMicrosecond)
          ->UseManualTime()
          ->Iterations(1);
    }
  }
}

}  // namespace ist::bench
