// What the circuit of src/hardware would have to do in a tick, along a closing: pairs tested,
// nodes read from memory, centres moved; and how often it calls a near miss a hit.
//
// The way down is the reference's, with each pair decided by the model. The time is the model's on
// a processor, and says nothing about a circuit.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>

#include "hardware/pair_walk.h"
#include "ist/tree/lookup_table.h"
#include "ist/tree/tree_parts.h"
#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {
namespace {

using test::HardwareNode;

// In double, whose rounding is a thousand times less than the circuit's: for counting.
class PlainTest {
 public:
  PlainTest(const QuantizedPose& pose, double ratio) : ratio_(ratio) {
    for (std::size_t k = 0; k < 9; ++k) rotation_[k] = 0x1p-28 * pose.rotation[k];
    for (std::size_t i = 0; i < 3; ++i) {
      translation_[i] = 0x1p-28 * static_cast<double>(pose.translation[i]);
    }
  }

  [[nodiscard]] bool touch(const HardwareNode& fixed, const HardwareNode& moving) const {
    const std::array<double, 3> a = centre(fixed), b = centre(moving);
    double squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      double d = translation_[i] - a[i];
      for (std::size_t k = 0; k < 3; ++k) d += rotation_[3 * k + i] * b[k];
      squared += d * d;
    }
    const double reach = radius(fixed) + ratio_ * radius(moving);
    return squared <= reach * reach;
  }

 private:
  static double scale(const HardwareNode& node) { return static_cast<double>(1 << node.level); }
  static double radius(const HardwareNode& node) {
    return scale(node) * std::sqrt(static_cast<double>(kLookupTable[node.mask].radius_squared));
  }
  static std::array<double, 3> centre(const HardwareNode& node) {
    const TableBall ball = kLookupTable[node.mask];
    const double s = scale(node);
    return {node.centre[0] + s * ball.x, node.centre[1] + s * ball.y, node.centre[2] + s * ball.z};
  }

  std::array<double, 9> rotation_{};
  std::array<double, 3> translation_{};
  double ratio_;
};

void count(benchmark::State& state, double voxel_size, double dz) {
  const auto& [fixed, moving] = trees(voxel_size);
  const QuantizedPose pose =
      quantize_pose(closing(dz), voxels_of(fixed).lattice, voxels_of(moving).lattice);
  const PlainTest plain(pose, moving.voxel_size() / fixed.voxel_size());
  const auto model = [&](const HardwareNode& a, const HardwareNode& b) {
    return test_pair(test::node_pair(pose, a, b), pose.registers).hit;
  };
  test::PairWalk walk(fixed, moving, model);
  auto counts = walk.run();
  for (auto _ : state) benchmark::DoNotOptimize(counts = walk.run());

  std::uint64_t misses = 0, false_hits = 0, false_misses = 0;
  const auto compared = [&](const HardwareNode& a, const HardwareNode& b) {
    const bool hit = model(a, b), touch = plain.touch(a, b);
    misses += touch ? 0u : 1u;
    false_hits += hit && !touch ? 1u : 0u;
    false_misses += touch && !hit ? 1u : 0u;
    return hit;
  };
  static_cast<void>(test::PairWalk(fixed, moving, compared).run());
  const auto exact =
      test::PairWalk(fixed, moving, [&](const HardwareNode& a, const HardwareNode& b) {
        return plain.touch(a, b);
      }).run();

  const auto tell = [&state](const char* name, std::uint64_t number) {
    state.counters[name] = static_cast<double>(number);
  };
  tell("pairs", counts.tested);
  tell("pairs_exact", exact.tested);
  tell("contacts", counts.leaf_pairs);
  tell("contacts_exact", exact.leaf_pairs);
  tell("opened", counts.opened);
  tell("words", counts.words);
  tell("moved", counts.moved);
  tell("misses", misses);
  tell("false_hits", false_hits);
  tell("false_misses", false_misses);
  state.counters["false_hit_rate"] =
      misses == 0 ? 0 : static_cast<double>(false_hits) / static_cast<double>(misses);
  state.counters["word_bytes"] = 8;  // a mask and a first child
  state.counters["voxel_size"] = voxel_size;
  tell("nodes", voxels_of(fixed).octree.node_count() + voxels_of(moving).octree.node_count());
  state.SetLabel(pair_name());
}

const int kRegistered = [] {
  for (const double size : {0.8, 0.4, 0.2}) {
    for (const double dz : kClosing) {
      benchmark::RegisterBenchmark(fmt::format("hardware/{:.1f}/{:.1f}", size, dz).c_str(),
                                   [=](benchmark::State& state) { count(state, size, dz); })
          ->Unit(benchmark::kMillisecond)
          ->Iterations(quick() ? 1 : 5);
    }
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
