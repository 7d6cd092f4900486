// The parts that a step of the search is made of, each for itself, for every instruction set that
// this machine has: all data in the first-level cache, as it is when a batch is tested.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "ist/query/traversal/search_plan.h"
#include "simd/dispatch.h"
#include "simd/lanes.h"
#include "support/bodies.h"

namespace ist::bench {
namespace {

constexpr std::uint32_t kBlocks = 64;

// Neighbouring blocks of leaves, one beside the other, and a motion that brings the two trees'
// first blocks together.
struct Data {
  explicit Data(SpherePolicy with)
      : slabs(with == SpherePolicy::kSlab),
        plan(trees(0.4).first, trees(0.4).second, with),
        step(plan.steps().back()) {
    pose.rotation[0] = pose.rotation[4] = pose.rotation[8] = 1;
    pose.ball_pad = pose.slab_pad = 1e-4F;
    kScalarKernels.parts.decode(step.moving, 0, *moving, 0);
    for (const Lane lane : {kX, kY, kZ}) pose.translation[lane] = moving->lane[lane][0];
    decode(step.fixed, 0, fixed, 0);
    for (const Lane lane : {kX, kY, kZ}) pose.translation[lane] -= fixed.lane[lane][0];
    kScalarKernels.parts.turn(pose, slabs, fixed, rows);
    for (std::uint32_t node = 0; lanes < MovingLanes::kSize - 8; ++node) {
      lanes += kScalarKernels.parts.decode(step.moving, node, *moving, lanes);
    }
  }

  bool slabs;
  SearchPlan plan;
  SearchStep step;
  SearchPose pose{};
  FixedLanes fixed{};
  FixedRows rows{};
  std::unique_ptr<MovingLanes> moving = std::make_unique<MovingLanes>();
  std::size_t lanes = 0;
};

const Data& data(SpherePolicy policy) {
  static const Data slab(SpherePolicy::kSlab), tight(SpherePolicy::kTight);
  return policy == SpherePolicy::kSlab ? slab : tight;
}

// Ends the program where a part is not what its scalar twin is: its time would mean nothing.
void require_twin(bool same, const Kernels& kernels, const char* part) {
  if (same) return;
  std::cerr << kernels.target << ": " << part << " differs from its scalar twin\n";
  std::exit(1);
}

void report(benchmark::State& state, const char* unit, std::size_t count) {
  state.counters[unit] =
      benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}

void decode_blocks(benchmark::State& state, const Kernels& kernels, SpherePolicy policy) {
  const Data& d = data(policy);
  const auto pass = [&](const Kernels& by, MovingLanes& out) {
    std::size_t at = 0;
    for (std::uint32_t node = 0; node < kBlocks; ++node) {
      at += by.parts.decode(d.step.moving, node, out, at);
    }
    return at;
  };
  const auto out = std::make_unique<MovingLanes>(), twin = std::make_unique<MovingLanes>();
  const std::size_t lanes = pass(kernels, *out);
  bool same = lanes == pass(kScalarKernels, *twin);
  for (std::size_t lane = 0; lane < (d.slabs ? kLanes : kRadius + 1); ++lane) {
    same = same && std::equal(out->lane[lane], out->lane[lane] + lanes, twin->lane[lane]);
  }
  require_twin(same, kernels, "decode");
  for (auto _ : state) benchmark::DoNotOptimize(pass(kernels, *out));
  report(state, "a_block", kBlocks);
}

void turn_rows(benchmark::State& state, const Kernels& kernels, SpherePolicy policy) {
  const Data& d = data(policy);
  FixedRows rows{};
  kernels.parts.turn(d.pose, d.slabs, d.fixed, rows);
  require_twin(std::memcmp(&rows, &d.rows, sizeof rows) == 0, kernels, "turn");
  for (auto _ : state) {
    kernels.parts.turn(d.pose, d.slabs, d.fixed, rows);
    benchmark::ClobberMemory();
  }
  report(state, "a_block", 1);
}

void overlap_row(benchmark::State& state, const Kernels& kernels, SpherePolicy policy,
                 std::size_t lanes) {
  const Data& d = data(policy);
  constexpr std::size_t kRows = 4;
  std::vector<std::uint32_t> out(lanes + 16), twin(lanes + 16);
  const auto pass = [&](const Kernels& by, std::vector<std::uint32_t>& to) {
    std::size_t touching = 0;
    for (std::size_t row = 0; row < kRows; ++row) {
      touching += by.parts.overlap_row(d.rows, row, *d.moving, 0, lanes, d.slabs, to.data());
    }
    return touching;
  };
  const std::size_t touching = pass(kernels, out);
  require_twin(touching == pass(kScalarKernels, twin), kernels, "overlap_row");
  for (auto _ : state) benchmark::DoNotOptimize(pass(kernels, out));
  report(state, "a_test", kRows * lanes);
  state.counters["touching"] = static_cast<double>(touching) / static_cast<double>(kRows * lanes);
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
    for (const SpherePolicy policy : {SpherePolicy::kTight, SpherePolicy::kSlab}) {
      const std::string with = target + "/" + std::string(to_string(policy));
      add("decode" + with, [=](benchmark::State& s) { decode_blocks(s, kernels, policy); });
      add("turn" + with, [=](benchmark::State& s) { turn_rows(s, kernels, policy); });
      for (const std::size_t lanes : {4u, 18u, 64u, 1000u}) {
        add("overlap_row" + with + "/" + std::to_string(lanes),
            [=](benchmark::State& s) { overlap_row(s, kernels, policy, lanes); });
      }
    }
    add("write_leaf_pairs" + target, [=](benchmark::State& s) { write_leaf_pairs(s, kernels); });
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
