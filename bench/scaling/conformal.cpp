// Bodies that lie along each other, which is the most there can be to find: time against the area
// that does.
#include "support/conformal.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>
#include <iostream>
#include <vector>

#include "scaling/asked.h"
#include "scaling/series.h"
#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {
namespace {

constexpr double kVoxelSize = 0.2;

struct Case {
  bool shells;  // else plates
  double gap, radius;
  int level;  // of a shell: facets of 0.7 mm whatever the radius
};

double area_of(const Case& c) {
  constexpr double kPi = 3.14159265358979323846;
  return c.shells ? 4 * kPi * c.radius * c.radius : 4 * c.radius * c.radius;
}

test::ConformalPair pair_of(const Case& c) {
  return c.shells ? test::shell_in_shell(c.level, c.radius, c.gap)
                  : test::plates(2 * c.radius, c.gap);
}

// The pair's own place, and one a hundredth of a voxel beside it, so that none is asked twice in a
// row.
std::vector<Eigen::Isometry3d> places() {
  std::vector<Eigen::Isometry3d> poses(2, Eigen::Isometry3d::Identity());
  poses[1].translation().x() = 0.01 * kVoxelSize;
  return poses;
}

void require_gap(const std::pair<SphereTree, SphereTree>& trees, double wanted) {
  Query query(trees.first, trees.second);
  const DistanceInterval gap = query.distance(Eigen::Isometry3d::Identity(), 0.1 * wanted).distance;
  if (gap.lower <= 1.01 * wanted && gap.upper >= 0.99 * wanted) return;
  std::cerr << "a gap of " << wanted << " is not in [" << gap.lower << ", " << gap.upper << "]\n";
  std::exit(1);
}

void report(benchmark::State& state, const Case& c) {
  const test::ConformalPair pair = pair_of(c);
  const std::pair<SphereTree, SphereTree> trees{
      build(pair.fixed, kVoxelSize, SpherePolicy::kSlab),
      build(pair.moving, kVoxelSize, SpherePolicy::kSlab)};
  require_gap(trees, pair.gap);
  Series series([&] { return ask(trees, places(), {rounds(20)}); });
  series.report(state, 0);
  state.counters["voxel_size"] = kVoxelSize;
  state.counters["area_mm2"] = area_of(c);
  state.counters["leaves"] =
      static_cast<double>(trees.first.leaf_count()) + trees.second.leaf_count();
}

}  // namespace

void add_conformal() {
  for (const bool shells : {false, true}) {
    for (const double gap : {0.05, 0.5}) {
      for (int level = 4; level <= (quick() ? 5 : 7); ++level) {
        const Case c{shells, gap, 5.0 * (1 << (level - 4)), level};
        benchmark::RegisterBenchmark(
            fmt::format("conformal/{}/{}/{}", shells ? "shells" : "plates", gap, c.radius).c_str(),
            [=](benchmark::State& state) { report(state, c); })
            ->Unit(benchmark::kMicrosecond)
            ->UseManualTime()
            ->Iterations(1);
      }
    }
  }
}

}  // namespace ist::bench
