#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "accuracy/approaches.h"
#include "accuracy/sections.h"
#include "ist/query/promise/leaf_geometry.h"
#include "ist/query/promise/promise_check.h"
#include "query/query_cases.h"
#include "support/latencies.h"

namespace ist::bench {
namespace {

using Pose = Eigen::Isometry3d;

struct Verdict {
  Pose pose;
  bool touch;  // of triangles
};

// Round the contact of every way, and what triangles say there.
const std::vector<Verdict>& verdicts() {
  static const std::vector<Verdict> made = [] {
    constexpr int kAWay = 20;
    constexpr double kBefore = 1.5, kBehind = 0.5;  // mm
    std::vector<Verdict> all;
    test::Random random(11);
    for (const Approach& way : approaches()) {
      for (int i = 0; i < kAWay; ++i) {
        const Pose pose = way.pose(way.contact + random.uniform(-kBefore, kBehind));
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
  Leaves(const SphereTree& tree, const RelativePose* move)
      : tree_(tree), codes_(tree.octree().codes(0)), move_(move) {}

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
    for (Eigen::Vector3d& corner : out.corners) {
      corner = move_->rotation * corner + move_->translation;
    }
    return out;
  }

  const SphereTree& tree_;
  const std::vector<std::uint64_t> codes_;
  const RelativePose* move_;
  std::map<std::uint32_t, std::vector<ClippedTriangle>> made_;
};

// How many of the leaf pairs hold triangles that cross inside of them.
std::uint64_t crossing(const SphereTree& fixed, const SphereTree& moving, const Pose& pose,
                       const std::vector<Contact>& contacts) {
  const RelativePose relative = *relative_pose(pose, fixed.lattice(), moving.lattice());
  const double tolerance =
      PromiseCheck::kTolerance * (fixed.reach() + moving.reach() + relative.translation.norm());
  Leaves of_fixed(fixed, nullptr), of_moving(moving, &relative);
  std::uint64_t count = 0;
  for (const Contact& contact : contacts) {
    const auto& as = of_fixed.of(contact.fixed);
    const auto& bs = of_moving.of(contact.moving);
    const bool cross = std::any_of(as.begin(), as.end(), [&](const ClippedTriangle& a) {
      return std::any_of(bs.begin(), bs.end(),
                         [&](const ClippedTriangle& b) { return surely_cross(a, b, tolerance); });
    });
    if (cross) ++count;
  }
  return count;
}

void judge(benchmark::State& state, double voxel_size, SpherePolicy policy) {
  const auto& [fixed, moving] = exact_trees(voxel_size);
  CollisionQuery query(fixed, moving, with_policy(policy));
  double missed = 0, false_alarms = 0, touching = 0;
  std::vector<Contact> contacts(1 << 20);
  for (auto _ : state) {
    for (const Verdict& verdict : verdicts()) {
      const bool said = query.collide(verdict.pose, std::span<Contact>()).contacts > 0;
      touching += verdict.touch ? 1 : 0;
      missed += verdict.touch && !said ? 1 : 0;
      false_alarms += !verdict.touch && said ? 1 : 0;
    }
    const QueryResult result = query.collide(closing(0), contacts);
    if (result.truncated) {
      state.SkipWithError("there are more contacts than there is room for");
      return;
    }
    contacts.resize(result.contacts);
    const GivenAnswer answer{result, contacts};
    const auto breach = PromiseCheck(fixed, moving, policy).check(closing(0), {&answer, 1});
    if (breach) {
      state.SkipWithError(breach->what.c_str());
      return;
    }
    state.counters["leaf_pairs"] = static_cast<double>(result.contacts);
    state.counters["crossing"] = static_cast<double>(crossing(fixed, moving, closing(0), contacts));
  }
  const auto n = static_cast<double>(verdicts().size());
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
