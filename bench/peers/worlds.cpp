#include "peers/worlds.h"

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <memory>
#include <string>
#include <vector>

#include "ist/models/models.h"
#include "peers/libraries.h"
#include "support/effort.h"
#include "support/latencies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

constexpr std::size_t kEdge = 10;  // balls along an edge of the grid
constexpr double kMoved = 0.01;    // radii
constexpr double kPart = 0.1;      // of the seconds, for an arrangement

// Balls of radius 1 on a grid. The distance of neighbours in a row alternates, so that half of
// them touch if `narrow` is less than 2.
struct Arrangement {
  const char* name;
  double narrow, wide;
};
constexpr Arrangement kArrangements[] = {
    {"all_touch", 1.9, 1.9}, {"half_touch", 1.95, 2.05}, {"close", 2.01, 2.01}, {"far", 3, 3}};

std::vector<Eigen::Vector3d> places(const Arrangement& of, double shift) {
  std::vector<double> along;
  for (std::size_t k = 0; k < kEdge; ++k) {
    along.push_back(k == 0 ? 0 : along.back() + (k % 2 == 1 ? of.narrow : of.wide));
  }
  std::vector<Eigen::Vector3d> all;
  for (std::size_t i = 0; i < kEdge * kEdge * kEdge; ++i) {
    all.emplace_back(along[i % kEdge] + shift * static_cast<double>(i % 3),
                     along[i / kEdge % kEdge], along[i / kEdge / kEdge]);
  }
  return all;
}

// In use by malloc, in arenas and mapped.
double allocated_mb() {
  const struct mallinfo2 info = mallinfo2();
  return 1e-6 * static_cast<double>(info.uordblks + info.hblkhd);
}

struct Player {
  std::string name;
  std::unique_ptr<Crowd> crowd;
  Latencies set_up, first, moved;  // µs
  std::uint64_t touching = 0, touching_moved = 0;
  double held_mb = 0;

  void take_turn(const std::vector<Eigen::Vector3d>& at, const std::vector<Eigen::Vector3d>& then) {
    const double before = allocated_mb();
    const Stopwatch setting_up;
    crowd->set_up(at);
    set_up.add(setting_up.microseconds());
    const Stopwatch asking;
    touching = crowd->touching();
    first.add(asking.microseconds());
    const Stopwatch moving;
    crowd->move(then);
    touching_moved = crowd->touching();
    moved.add(moving.microseconds());
    if (held_mb == 0) held_mb = allocated_mb() - before;  // the first world replaces none
  }
};

// Everybody's turns at an arrangement, made when the first benchmark asks for its numbers.
class Contest {
 public:
  Contest(const Arrangement& of, double seconds) : of_(of), seconds_(seconds) {}

  std::vector<Player>& held() {
    if (!players_.empty()) return players_;
    const TriangleMesh ball = make_icosphere(3, 1);
    for (const Library& library : libraries()) {
      if (library.crowd) players_.push_back({library.name, library.crowd(ball), {}, {}, {}});
    }
    const std::vector<Eigen::Vector3d> at = places(of_, 0), then = places(of_, kMoved);
    const Stopwatch all;
    for (int round = 0; round < 3 || (!quick() && all.milliseconds() < 1e3 * seconds_); ++round) {
      for (Player& player : players_) player.take_turn(at, then);
    }
    return players_;
  }

 private:
  const Arrangement& of_;
  double seconds_;
  std::vector<Player> players_;
};

void report(benchmark::State& state, Contest& contest, std::size_t index) {
  Player &ist = contest.held().front(), &player = contest.held()[index];
  if (player.touching != ist.touching || player.touching_moved != ist.touching_moved) {
    state.SkipWithError("other pairs intersect than IST finds");
    return;
  }
  const double set_up = player.set_up.quantile(0.5), first = player.first.quantile(0.5);
  for (auto _ : state) state.SetIterationTime(1e-6 * (set_up + first));
  state.counters["set_up_us"] = set_up;
  state.counters["first_us"] = first;
  state.counters["moved_us"] = player.moved.quantile(0.5);
  state.counters["touching"] = static_cast<double>(player.touching);
  state.counters["held_mb"] = player.held_mb;
  state.counters["bodies"] = static_cast<double>(kEdge * kEdge * kEdge);
  state.counters["n"] = static_cast<double>(player.first.size());
}

}  // namespace

void add_worlds(double seconds) {
  std::vector<std::string> names;
  for (const Library& library : libraries()) {
    if (library.crowd) names.push_back(library.name);
  }
  for (const Arrangement& of : kArrangements) {
    const auto contest = std::make_shared<Contest>(of, kPart * seconds);
    for (std::size_t k = 0; k < names.size(); ++k) {
      benchmark::RegisterBenchmark(("worlds/" + std::string(of.name) + "/" + names[k]).c_str(),
                                   [=](benchmark::State& state) { report(state, *contest, k); })
          ->Unit(benchmark::kMillisecond)
          ->UseManualTime()
          ->Iterations(1);
    }
  }
}

}  // namespace ist::bench
