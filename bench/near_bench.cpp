// Near pairs of two jaws that slide along each other, just apart: with lists that are kept from
// pose to pose, beside fresh searches. Both answer every tick, turn and turn about; the least time
// of several rounds counts for a tick. All pairs of triangles that intersect, of the closed jaws,
// stand beside them. A tick with lists should cost at most 1.15 times a fresh search, at any speed:
// p99.9_ratio. `tests` are those of a fresh search, and `measured` the pairs of a list that are
// measured again, both of a tick in the mean.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "ist/query/query.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/latencies.h"

namespace ist::bench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kVoxelSize = 0.4;  // which does not matter
constexpr double kMargin = 0.06, kGap = 0.005;
constexpr std::size_t kKept = 4096;

Eigen::Isometry3d at(double x, double z) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, 0, z);
  return pose;
}

// Heights of the lower jaw at which it is about to touch, every 50 µm from side to side.
const std::vector<double>& heights() {
  static const std::vector<double> made = [] {
    const auto& [fixed, moving] = triangle_trees(kVoxelSize);
    Query query(fixed, moving);
    std::vector<double> z;
    for (int k = -30; k <= 30; ++k) {
      double apart = -12, meets = 0;
      for (int i = 0; i < 24; ++i) {
        const double middle = 0.5 * (apart + meets);
        const bool touches = query.intersects(at(0.05 * k, middle)).answer == Answer::kYes;
        (touches ? meets : apart) = middle;
      }
      z.push_back(apart - kGap);
    }
    return z;
  }();
  return made;
}

// Slides to and fro at a speed, mm a tick, as near as that speed allows.
std::vector<Eigen::Isometry3d> slide(double speed) {
  std::vector<Eigen::Isometry3d> poses;
  double z = heights().front();
  for (int tick = 0; tick < rounds(3000); ++tick) {
    const double way = std::fmod(tick * speed, 6.0), x = (way < 3 ? way : 6 - way) - 1.5;
    const auto k = std::min<std::size_t>(59, static_cast<std::size_t>((x + 1.5) / 0.05));
    z += std::clamp(std::min(heights()[k], heights()[k + 1]) - z, -speed, speed);
    poses.push_back(at(x, z));
  }
  return poses;
}

struct Way {
  Way(const QueryOptions& options, std::size_t ticks)
      : query(triangle_trees(kVoxelSize).first, triangle_trees(kVoxelSize).second, options),
        pairs(1 << 14),
        least(ticks, HUGE_VAL) {}

  void answer(std::size_t tick, const Eigen::Isometry3d& pose) {
    const Clock::time_point begin = Clock::now();
    result = query.near_pairs(pose, kMargin, pairs);
    const std::chrono::duration<double, std::micro> time = Clock::now() - begin;
    least[tick] = std::min(least[tick], time.count());
  }
  // Returns the times of 999 of 1,000 ticks, and in the mean, µs.
  std::pair<double, double> report(benchmark::State& state, const std::string& name) const {
    Latencies latencies;
    double sum = 0;
    for (const double time : least) {
      latencies.add(time);
      sum += time;
    }
    latencies.report(state, name + "_");
    const double mean = sum / static_cast<double>(least.size());
    state.counters[name + "_mean_us"] = mean;
    return {latencies.quantile(0.999), mean};
  }

  Query query;
  std::vector<NearPair> pairs;
  std::vector<double> least;
  NearPairsResult result;
};

bool same(const Way& a, const Way& b) {
  if (a.result.near_pairs != b.result.near_pairs || !a.result.complete) return false;
  return std::equal(a.pairs.begin(),
                    a.pairs.begin() + static_cast<std::ptrdiff_t>(a.result.near_pairs),
                    b.pairs.begin(), [](const NearPair& p, const NearPair& q) {
                      return p.triangles == q.triangles &&
                             std::memcmp(&p.distance, &q.distance, 7 * sizeof(double)) == 0;
                    });
}

void ticks(benchmark::State& state, double speed) {
  const std::vector<Eigen::Isometry3d> poses = slide(speed);
  Way fresh({}, poses.size()), kept({.near_pairs = kKept}, poses.size());
  std::size_t by_list = 0, pairs = 0, most = 0;
  std::uint64_t tests = 0, measured = 0;
  int round = 0;
  for (auto _ : state) {
    kept.query.forget();
    by_list = pairs = 0;
    tests = measured = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (round % 2 == 0) fresh.answer(i, poses[i]);
      kept.answer(i, poses[i]);
      if (round % 2 == 1) fresh.answer(i, poses[i]);
      if (!same(fresh, kept)) {
        state.SkipWithError("an answer depends on the lists");
        return;
      }
      tests += fresh.result.sphere_tests;
      if (kept.result.found == Found::kKept) {
        ++by_list;
        measured += kept.result.sphere_tests;
      }
      pairs += kept.result.near_pairs;
      most = std::max<std::size_t>(most, kept.result.near_pairs);
    }
    ++round;
  }
  const auto [fresh_tail, fresh_mean] = fresh.report(state, "fresh");
  const auto [kept_tail, kept_mean] = kept.report(state, "kept");
  state.counters["p99.9_ratio"] = kept_tail / fresh_tail;
  state.counters["mean_ratio"] = kept_mean / fresh_mean;
  state.counters["tests"] = static_cast<double>(tests) / static_cast<double>(poses.size());
  state.counters["measured"] =
      by_list > 0 ? static_cast<double>(measured) / static_cast<double>(by_list) : 0;
  state.counters["ticks"] = static_cast<double>(poses.size());
  state.counters["by_list"] = static_cast<double>(by_list);
  state.counters["pairs"] = static_cast<double>(pairs) / static_cast<double>(poses.size());
  state.counters["most_pairs"] = static_cast<double>(most);
  state.SetLabel(pair_name());
}

// At first contact, afresh, and beside it all pairs that intersect if the jaws are closed.
void first_contact(benchmark::State& state, double margin) {
  const auto& [fixed, moving] = triangle_trees(kVoxelSize);
  Query query(fixed, moving);
  std::vector<NearPair> pairs(1 << 15);
  std::vector<TrianglePair> meeting(1 << 15);
  const Eigen::Isometry3d pose = at(0, heights()[30] + kGap);
  Latencies near, closed;
  std::uint64_t found = 0;
  for (auto _ : state) {
    const Clock::time_point begin = Clock::now();
    found = query.near_pairs(pose, margin, pairs).near_pairs;
    const Clock::time_point middle = Clock::now();
    benchmark::DoNotOptimize(query.triangle_pairs(at(0, 0), meeting));
    near.add(std::chrono::duration<double, std::micro>(middle - begin).count());
    closed.add(std::chrono::duration<double, std::micro>(Clock::now() - middle).count());
  }
  state.counters["near_p50_us"] = near.quantile(0.5);
  state.counters["closed_pairs_p50_us"] = closed.quantile(0.5);
  state.counters["pairs"] = static_cast<double>(found);
  state.SetLabel(pair_name());
}

const bool kAdded = [] {
  for (const double margin : {0.03, 0.06, 0.1, 0.2, 0.3}) {
    benchmark::RegisterBenchmark(fmt::format("near/first_contact/{}", margin).c_str(),
                                 [=](benchmark::State& state) { first_contact(state, margin); })
        ->Iterations(rounds(90));
  }
  for (const double speed : {0.001, 0.002, 0.01, 0.02, 0.03, 0.05, 0.1}) {
    benchmark::RegisterBenchmark(fmt::format("near/slide/{}", speed).c_str(),
                                 [=](benchmark::State& state) { ticks(state, speed); })
        ->Iterations(rounds(90) / 18 + 1);
  }
  return true;
}();

}  // namespace
}  // namespace ist::bench
