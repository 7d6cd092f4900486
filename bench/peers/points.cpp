#include "peers/points.h"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <memory>

#include "ist/measure/signed_distance.h"
#include "peers/libraries.h"
#include "peers/poses.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/latencies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

using Points = std::vector<Eigen::Vector3d>;
constexpr double kReach = 2;        // mm
constexpr double kRounding = 1e-9;  // what two ways to compute a distance may differ by, mm

// The vertices of `body` that are near `other`, in its coordinates.
Points near_vertices(const SphereTree& body, const SphereTree& other,
                     const Eigen::Isometry3d& pose) {
  const std::vector<SurfaceDistance> map = distance_map(body, other, pose, kReach);
  Points near;
  for (std::size_t v = 0; v < map.size(); ++v) {
    if (!std::isnan(map[v].distance)) near.push_back(pose * body.triangles()->vertices[v]);
  }
  return near;
}

struct Player {
  std::string name;
  Library::MeasurePoints to_fixed, to_moving;
  std::vector<Latencies> latencies;  // of each pose
  double error = 0;                  // the largest difference from IST
};

// Everybody's turns, made when the first benchmark asks for its numbers.
class Contest {
 public:
  explicit Contest(double seconds) : seconds_(seconds), poses_(closing_poses()) {
    for (const Library& library : libraries()) {
      if (library.points) players_.push_back({library.name, {}, {}, {}, 0});
    }
  }
  [[nodiscard]] const std::vector<NamedPose>& poses() const { return poses_; }
  [[nodiscard]] std::vector<Player>& players() { return players_; }
  [[nodiscard]] std::size_t points(std::size_t pose) const { return points_[pose]; }

  void hold() {
    if (!points_.empty()) return;
    for (const Library& library : libraries()) {
      for (Player& player : players_) {
        if (player.name != library.name) continue;
        player.to_fixed = library.points(upper_jaw());
        player.to_moving = library.points(lower_jaw());
        player.latencies.resize(poses_.size());
      }
    }
    for (std::size_t at = 0; at < poses_.size(); ++at) hold(at);
  }

 private:
  void hold(std::size_t at) {
    const auto& [fixed, moving] = triangle_trees(voxel_size());
    const Eigen::Isometry3d& pose = poses_[at].pose;
    const Points of_moving = near_vertices(moving, fixed, pose);
    const Points of_fixed = near_vertices(fixed, moving, pose.inverse());
    points_.push_back(of_moving.size() + of_fixed.size());
    std::vector<double> first, distances(points_.back());
    const Stopwatch all;
    for (int round = 0; round < 3 || (!quick() && all.milliseconds() < 1e3 * seconds_); ++round) {
      for (Player& player : players_) {
        const std::span out(distances);
        const Stopwatch watch;
        player.to_fixed(of_moving, out.first(of_moving.size()));
        player.to_moving(of_fixed, out.subspan(of_moving.size()));
        if (round > 0) player.latencies[at].add(watch.microseconds());
        if (first.empty()) first = distances;
        for (std::size_t i = 0; i < first.size(); ++i) {
          player.error = std::max(player.error, std::abs(distances[i] - first[i]));
        }
      }
    }
  }

  double seconds_;
  std::vector<NamedPose> poses_;
  std::vector<Player> players_;
  std::vector<std::size_t> points_;
};

void report(benchmark::State& state, Contest& contest, std::size_t player, std::size_t pose) {
  contest.hold();
  Player& of = contest.players()[player];
  Latencies& latencies = of.latencies[pose];
  if (!(of.error < kRounding)) {
    state.SkipWithError("a distance differs from IST's");
    return;
  }
  for (auto _ : state) state.SetIterationTime(1e-6 * latencies.quantile(0.5));
  latencies.report(state);
  state.counters["n"] = static_cast<double>(latencies.size());
  state.counters["reach_mm"] = kReach;
  state.counters["points"] = static_cast<double>(contest.points(pose));
  state.SetLabel(contest.poses()[pose].label);
}

}  // namespace

void add_points(double seconds) {
  const auto contest = std::make_shared<Contest>(0.05 * seconds);
  for (std::size_t player = 0; player < contest->players().size(); ++player) {
    for (std::size_t pose = 0; pose < contest->poses().size(); ++pose) {
      const std::string name =
          "points/distances/" + contest->players()[player].name + "/" + contest->poses()[pose].name;
      benchmark::RegisterBenchmark(
          name.c_str(), [=](benchmark::State& state) { report(state, *contest, player, pose); })
          ->Unit(benchmark::kMicrosecond)
          ->UseManualTime()
          ->Iterations(1);
    }
  }
}

}  // namespace ist::bench
