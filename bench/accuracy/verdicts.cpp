#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "accuracy/approaches.h"
#include "accuracy/sections.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "support/latencies.h"
#include "verify/answer_verifier.h"
#include "verify/frame_motion.h"
#include "verify/leaf_geometry.h"

namespace ist::bench {
namespace {

using Pose = Eigen::Isometry3d;

// How far from first contact poses are, mm.
constexpr double kBefore = 1.5, kBehind = 0.5;

struct ChunkState {
  Pose pose;
  bool touch;  // of triangles
};

// Round the contact of every way, and what triangles say there.
const std::vector<ChunkState>& verdicts() {
  static const std::vector<ChunkState> made = [] {
    constexpr int kAWay = 20;
    std::vector<ChunkState> all;
    test::Random random(11);
    for (const Approach& way : approaches()) {
      for (int i = 0; i < kAWay; ++i) {
        const Pose pose = way.pose(way.pair + random.uniform(-kBefore, kBehind));
        all.push_back({pose, exact_touch(pose)});
      }
    }
    return all;
  }();
  return made;
}

// Leaves' triangles, clipped to their cubes and moved to the fixed tree's frame.
class Leaves {
 public:
  Leaves(const SphereTree& tree, const Pose* move)
      : tree_(tree), codes_(voxels_of(tree).octree.codes(0)), move_(move) {}

  const std::vector<ClippedTriangle>& of(std::uint32_t leaf) {
    const auto [at, is_new] = made_.try_emplace(leaf);
    if (is_new) {
      at->second = leaf_polygons(tree_, leaf, codes_[leaf]);
      if (move_ != nullptr) {
        for (ClippedTriangle& polygon : at->second) polygon = moved(polygon);
      }
    }
    return at->second;
  }

 private:
  [[nodiscard]] ClippedTriangle moved(const ClippedTriangle& polygon) const {
    ClippedTriangle out = polygon;
    for (Eigen::Vector3d& corner : out.corners) corner = *move_ * corner;
    return out;
  }

  const SphereTree& tree_;
  const std::vector<std::uint64_t> codes_;
  const Pose* move_;
  std::map<std::uint32_t, std::vector<ClippedTriangle>> made_;
};

// How many of the leaf pairs hold triangles that cross inside of them.
std::uint64_t crossing(const SphereTree& fixed, const SphereTree& moving, const Pose& pose,
                       const std::vector<LeafPair>& leaf_pairs) {
  const auto [motion, error] =
      frame_motion(pose, voxels_of(fixed).lattice, voxels_of(moving).lattice);
  const double lengths =
      fixed.bounding_radius() + moving.bounding_radius() + motion.translation().norm();
  const double tolerance = AnswerVerifier::kTolerance * lengths + error;
  Leaves of_fixed(fixed, nullptr), of_moving(moving, &motion);
  std::uint64_t count = 0;
  for (const LeafPair& pair : leaf_pairs) {
    const auto& as = of_fixed.of(pair.fixed);
    const auto& bs = of_moving.of(pair.moving);
    const bool cross = std::any_of(as.begin(), as.end(), [&](const ClippedTriangle& a) {
      return std::any_of(bs.begin(), bs.end(),
                         [&](const ClippedTriangle& b) { return surely_cross(a, b, tolerance); });
    });
    if (cross) ++count;
  }
  return count;
}

void judge(benchmark::State& state, double voxel_size, SpherePolicy policy) {
  const auto& [fixed, moving] = triangle_trees(voxel_size);
  Query query(fixed, moving, with_policy(policy));
  double missed = 0, false_alarms = 0, touching = 0;
  std::vector<LeafPair> leaf_pairs(1 << 20);
  for (auto _ : state) {
    for (const ChunkState& verdict : verdicts()) {
      const bool said = query.leaf_pairs(verdict.pose, std::span<LeafPair>()).leaf_pairs > 0;
      touching += verdict.touch ? 1 : 0;
      missed += verdict.touch && !said ? 1 : 0;
      false_alarms += !verdict.touch && said ? 1 : 0;
    }
    const QueryResult result = query.leaf_pairs(closing(0), leaf_pairs);
    if (result.truncated) {
      state.SkipWithError("there are more contacts than there is room for");
      return;
    }
    leaf_pairs.resize(result.leaf_pairs);
    const GivenAnswer answer{result, leaf_pairs};
    const auto violation = AnswerVerifier(fixed, moving, policy).check(closing(0), {&answer, 1});
    if (violation) {
      state.SkipWithError(violation->detail.c_str());
      return;
    }
    state.counters["leaf_pairs"] = static_cast<double>(result.leaf_pairs);
    state.counters["crossing"] =
        static_cast<double>(crossing(fixed, moving, closing(0), leaf_pairs));
  }
  const auto n = static_cast<double>(verdicts().size());
  state.counters["before_mm"] = kBefore;
  state.counters["behind_mm"] = kBehind;
  state.counters["n"] = n;
  state.counters["touching"] = touching;
  state.counters["missed"] = missed;
  state.counters["false"] = false_alarms;
  state.SetLabel(pair_name());
}

}  // namespace

void add_verdicts() {
  for (const double size : accuracy_sizes()) {
    if (quick() && size > 0.4) continue;
    for (const SpherePolicy policy : kSpherePolicies) {
      benchmark::RegisterBenchmark(fmt::format("verdict/{:g}/{}", size, to_string(policy)).c_str(),
                                   [=](benchmark::State& state) { judge(state, size, policy); })
          ->Unit(benchmark::kMillisecond)
          ->Iterations(1);
    }
  }
}

}  // namespace ist::bench
