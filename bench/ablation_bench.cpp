// What each part of the fast query gives: parts added one by one to the published query, and left
// out one by one of the whole; and what a sphere costs that is not looked up.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ablation/comparison.h"
#include "ist/tree/bounds.h"
#include "ist/tree/enclosing_ball.h"
#include "ist/tree/implicit_ball.h"
#include "ist/tree/linear_octree.h"
#include "ist/tree/lookup_table_search.h"
#include "ist/tree/tree_parts.h"
#include "simd/dispatch.h"
#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {
namespace {

// The smallest ball round the children's cubes of a mask, in half edges of the node's cube from
// its centre.
using SphereOfMask = Ball (*)(std::uint8_t mask);

constexpr double kSixth = 1.0 / 6;

Ball in_half_edges(const TableBall& ball, std::size_t code) {
  return {{kSixth * ball.x, kSixth * ball.y, kSixth * ball.z}, kTableRadii[code]};
}

// By the code in the table's word, as a search takes it.
// From the table that the compiler made.
Ball looked_up(std::uint8_t mask) {
  return in_half_edges(kLookupTable[mask], kTableWords[mask] >> 9);
}

// By enclosing_ball() of the cubes' corners, to 1e-9 of the radius.
Ball enclosed(std::uint8_t mask) {
  std::array<Eigen::Vector3d, 27> corners;
  std::size_t count = 0;
  const std::uint32_t taken = lookup_table_detail::corners_of(mask);
  for (int i = 0; i < 27; ++i) {
    if ((taken >> i & 1) == 0) continue;
    const auto [x, y, z] = lookup_table_detail::corner(i);
    corners[count++] = {kSixth * x, kSixth * y, kSixth * z};
  }
  return enclosing_ball(std::span(corners).first(count), 1e-9);
}

// As the compiler makes the table: the best of 125 centres, in whole numbers.
Ball searched(std::uint8_t mask) {
  const TableBall ball = lookup_table_detail::smallest_ball(mask);
  return in_half_edges(ball, radius_code(ball));
}

constexpr std::pair<const char*, SphereOfMask> kWaysToMakeSpheres[] = {
    {"1-lookup", looked_up}, {"2-enclosing_ball", enclosed}, {"3-search", searched}};

// Masks of nodes just above the leaves, at most `count`, spread evenly over the tree. Ends the
// program where for any of them the ways to make a sphere differ by more than 1e-6 half edges.
std::vector<std::uint8_t> some_masks(const LinearOctree& octree, std::size_t count) {
  const std::span<const std::uint8_t> all = octree.masks(1);
  std::vector<std::uint8_t> masks;
  const std::size_t step = std::max<std::size_t>(1, all.size() / count);
  for (std::size_t i = 0; i < all.size() && masks.size() < count; i += step) {
    masks.push_back(all[i]);
  }
  for (const std::uint8_t mask : masks) {
    const Ball expected = looked_up(mask);
    for (const SphereOfMask make : {enclosed, searched}) {
      const Ball ball = make(mask);
      const double apart =
          std::max((ball.centre - expected.centre).norm(), std::abs(ball.radius - expected.radius));
      if (apart <= 1e-6) continue;
      std::cerr << "ablation: the sphere of mask " << int{mask} << " differs by " << apart
                << " half edges from that of the table\n";
      std::exit(1);
    }
  }
  return masks;
}

using Search = Parts::Search;
using Steps = std::vector<std::pair<std::string, Parts>>;

std::string best() { return all_kernels().front().target; }

// Each is the one before it with one part more, except that 3-linear_simple goes with 1. With the
// instruction sets of this processor, from the narrowest.
Steps ladder() {
  Steps steps = {
      {"1-pointers_simple", {Search::kPointers, SpherePolicy::kSimple}},
      {"2-pointers_table", {Search::kPointers, SpherePolicy::kTable}},
      {"3-linear_simple", {Search::kLinear, SpherePolicy::kSimple}},
      {"3-linear_table", {Search::kLinear, SpherePolicy::kTable}},
      {"4-batches", {Search::kBatches, SpherePolicy::kTable}},
      {"5-tight", {Search::kBatches, SpherePolicy::kTight}},
      {"6-slab", {Search::kBatches, SpherePolicy::kSlab}},
  };
  int step = 7;
  const auto kernels = all_kernels();
  for (auto k = kernels.rbegin() + 1; k != kernels.rend(); ++k) {  // the first is scalar
    steps.push_back({std::to_string(step++) + "-" + k->target,
                     {Search::kBatches, SpherePolicy::kSlab, k->target}});
  }
  steps.push_back({std::to_string(step) + "-second_worker",
                   {Search::kBatches, SpherePolicy::kSlab, best(), 2}});
  return steps;
}

// The whole, and the whole without the part that is named. Where a part builds on another, it goes
// with it: no second worker but in batches, no slab but on a tight ball.
Steps without() {
  return {
      {"0-full", {Search::kBatches, SpherePolicy::kSlab, best(), 2}},
      {"1-second_worker", {Search::kBatches, SpherePolicy::kSlab, best(), 1}},
      {"2-simd", {Search::kBatches, SpherePolicy::kSlab, "scalar", 2}},
      {"3-simd_and_worker", {Search::kBatches, SpherePolicy::kSlab, "scalar", 1}},
      {"4-slab", {Search::kBatches, SpherePolicy::kTight, best(), 2}},
      {"5-tight", {Search::kBatches, SpherePolicy::kTable, best(), 2}},
      {"6-table", {Search::kBatches, SpherePolicy::kSimple, best(), 2}},
      {"7-batches", {Search::kLinear, SpherePolicy::kSlab}},
      {"8-layout", {Search::kPointers, SpherePolicy::kSlab}},
  };
}

// The published query and the fast one, one worker, by policy: the same spheres on both sides.
Steps same() {
  Steps steps;
  for (const SpherePolicy policy : kSpherePolicies) {
    const std::string name(to_string(policy));
    steps.push_back({"published-" + name, {Search::kLinear, policy}});
    steps.push_back({"fast-" + name, {Search::kBatches, policy, best()}});
  }
  return steps;
}

// All variants of a voxel size, checked and measured when the first of them is to be reported.
Comparison& compared(double voxel_size) {
  static std::map<double, std::unique_ptr<Comparison>> made;
  auto& comparison = made[voxel_size];
  if (comparison == nullptr) {
    std::vector<Parts> parts;
    for (const Steps& steps : {ladder(), without(), same()}) {
      for (const auto& step : steps) parts.push_back(step.second);
    }
    comparison = std::make_unique<Comparison>(voxel_size, parts);
    comparison->check();
    comparison->measure(quick() ? 1 : voxel_size < 0.5 ? 90 : 60);
  }
  return *comparison;
}

void report(benchmark::State& state, double voxel_size, const Parts& parts, std::size_t pose) {
  for (auto _ : state) {
    state.SetIterationTime(1e-6 * compared(voxel_size).of(parts).latencies[pose].quantile(0.5));
  }
  Measured& measured = compared(voxel_size).of(parts);
  measured.latencies[pose].report(state);
  state.counters["tests"] = static_cast<double>(measured.results[pose].sphere_tests);
  state.counters["contacts"] = static_cast<double>(measured.results[pose].leaf_pairs);
  state.counters["bytes"] = static_cast<double>(measured.variant.bytes());
  state.counters["n"] = static_cast<double>(measured.rounds);
  state.SetLabel(pair_name());
}

// What the spheres of 2^16 nodes take, by a way to make one of a mask.
void make_spheres(benchmark::State& state, double voxel_size, SphereOfMask make) {
  const std::vector<std::uint8_t> masks =
      some_masks(voxels_of(trees(voxel_size).first).octree, 1 << 16);
  const auto begin = std::chrono::steady_clock::now();
  for (auto _ : state) {
    for (const std::uint8_t mask : masks) {
      const Ball ball = make(mask);
      benchmark::DoNotOptimize(&ball);
    }
  }
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
  const double spheres =
      static_cast<double>(state.iterations()) * static_cast<double>(masks.size());
  state.counters["ns_a_sphere"] = time.count() / spheres;
  state.counters["n"] = spheres;
  state.SetLabel(pair_name());
}

std::string number(double value) { return std::to_string(value).substr(0, value < 0 ? 4 : 3); }

void add(const std::string& kind, const Steps& steps, double voxel_size) {
  for (const auto& [name, parts] : steps) {
    for (std::size_t pose = 0; pose < kPoses; ++pose) {
      const std::string whole =
          "ablation/" + kind + "/" + name + "/" + number(voxel_size) + "/" + number(kClosing[pose]);
      benchmark::RegisterBenchmark(
          whole.c_str(), [=](benchmark::State& state) { report(state, voxel_size, parts, pose); })
          ->Unit(benchmark::kMicrosecond)
          ->UseManualTime()
          ->Iterations(1);
    }
  }
}

const int kRegistered = [] {
  for (const double size : {0.2, 0.8}) {
    add("ladder", ladder(), size);
    add("without", without(), size);
    add("same", same(), size);
  }
  for (const auto& [name, make] : kWaysToMakeSpheres) {
    benchmark::RegisterBenchmark(
        ("ablation/spheres/" + std::string(name) + "/0.2").c_str(),
        [make = make](benchmark::State& state) { make_spheres(state, 0.2, make); })
        ->Iterations(rounds(30))
        ->Unit(benchmark::kMillisecond);
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
