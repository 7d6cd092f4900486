// One step of the search for every instruction set that this machine has: groups of several sizes,
// all data in the first-level cache.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ist/query/traversal/search_plan.h"
#include "simd/dispatch.h"
#include "simd/lanes.h"
#include "support/bodies.h"

namespace ist::bench {
namespace {

constexpr std::uint32_t kGroups = 64;

// Groups of neighbouring blocks of leaves, and a motion that brings the two trees' first blocks
// together.
struct Data {
  Data(SpherePolicy with, std::uint32_t nodes)
      : plan(trees(0.4).first, trees(0.4).second, with), step(plan.steps().back()) {
    pose.rotation[0] = pose.rotation[4] = pose.rotation[8] = 1;
    pose.leaf = pose.inner = {1e-4F, 1e-4F, 1e-4F};
    decode(step.moving, 0, scratch->moving, 0);
    decode(step.fixed, 0, scratch->fixed[0].lanes, 0);
    for (const Lane lane : {kX, kY, kZ}) {
      pose.translation[lane] =
          scratch->moving.lane[lane][0] - scratch->fixed[0].lanes.lane[lane][0];
    }
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      for (std::uint32_t node = 0; node < nodes; ++node) moving.push_back(node);
      groups.push_back({group, static_cast<std::uint32_t>(moving.size())});
    }
    out_groups.resize(8 * kGroups + kFrontierSpare);
    out_moving.resize(64 * moving.size() + kFrontierSpare);
  }

  // Makes the step. Returns its tests.
  std::uint64_t advance(const Kernels& kernels, Measured measured) {
    out = {out_groups.data(), out_moving.data(), 0, 0, out_moving.size() - kFrontierSpare};
    const Frontier in{groups.data(), moving.data(), groups.size(), moving.size(), moving.size()};
    SearchCursor cursor;
    bounds = {};
    return kernels
        .advance(step, pose, in, cursor, out, *scratch, ~std::uint64_t{0}, measured, bounds)
        .tests;
  }

  SearchPlan plan;
  SearchStep step;
  SearchPose pose{};
  std::unique_ptr<SearchScratch> scratch = std::make_unique<SearchScratch>();
  std::vector<SearchGroup> groups, out_groups;
  std::vector<std::uint32_t> moving, out_moving;
  Frontier out{};
  DistanceBounds bounds;
};

// Ends the program where a kernel is not what its scalar twin is: its time would mean nothing.
void require_twin(bool same, const Kernels& kernels, const char* name) {
  if (same) return;
  std::cerr << kernels.target << ": " << name << " differs from its scalar twin\n";
  std::exit(1);
}

void report(benchmark::State& state, const char* unit, std::size_t count) {
  state.counters[unit] =
      benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}

void advance(benchmark::State& state, const Kernels& kernels, SpherePolicy policy,
             std::uint32_t nodes, Measured measured) {
  Data d(policy, nodes), twin(policy, nodes);
  const std::uint64_t tests = d.advance(kernels, measured);
  require_twin(tests == twin.advance(kScalarKernels, measured) &&
                   d.out.moving_count == twin.out.moving_count &&
                   d.bounds.upper == twin.bounds.upper && d.bounds.lower == twin.bounds.lower,
               kernels, "advance");
  for (auto _ : state) benchmark::DoNotOptimize(d.advance(kernels, measured));
  report(state, "a_test", tests);
  state.counters["overlapping"] =
      static_cast<double>(d.out.moving_count) / static_cast<double>(tests);
}

void write_leaf_pairs(benchmark::State& state, const Kernels& kernels) {
  // Rows of three, as they are in full occlusion.
  std::vector<SearchGroup> groups;
  std::vector<std::uint32_t> moving;
  for (std::uint32_t i = 0; i < 300; ++i) {
    for (int k = 0; k < 3; ++k) moving.push_back(7 * i);
    groups.push_back({i, static_cast<std::uint32_t>(moving.size())});
  }
  moving.resize(moving.size() + kFrontierSpare);
  const std::size_t count = groups.back().end;
  const Frontier leaves{groups.data(), moving.data(), groups.size(), count, count};
  std::vector<LeafPair> out(count + kLeafPairSpare), twin(count + kLeafPairSpare);
  kernels.write_leaf_pairs(leaves, out.data());
  kScalarKernels.write_leaf_pairs(leaves, twin.data());
  require_twin(
      std::equal(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count), twin.begin()),
      kernels, "write_leaf_pairs");
  for (auto _ : state) {
    kernels.write_leaf_pairs(leaves, out.data());
    benchmark::ClobberMemory();
  }
  report(state, "a_contact", count);
}

const int kRegistered = [] {
  const auto add = [](const std::string& name, auto function) {
    benchmark::RegisterBenchmark(name.c_str(), function);
  };
  for (const Kernels& kernels : all_kernels()) {
    const std::string target = std::string("/") + kernels.target;
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const std::uint32_t nodes : {1u, 5u, 18u, 250u}) {
        add("advance" + target + "/" + std::string(to_string(policy)) + "/" + std::to_string(nodes),
            [=](benchmark::State& s) { advance(s, kernels, policy, nodes, Measured::kNothing); });
      }
    }
    for (const auto& [name, measured] :
         {std::pair("upper", Measured::kUpper), std::pair("both", Measured::kBoth)}) {
      add("measure" + target + "/" + name, [=, m = measured](benchmark::State& s) {
        advance(s, kernels, SpherePolicy::kSlab, 5, m);
      });
    }
    add("write_leaf_pairs" + target, [=](benchmark::State& s) { write_leaf_pairs(s, kernels); });
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
