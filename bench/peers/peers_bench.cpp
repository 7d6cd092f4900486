// This library beside others that answer the same questions, in one run, on the closing and on the
// poses whose truth is known; at 0.2 mm where there are voxels, and all in one thread.
//
//   peers/build/LIBRARY                what its structures of both meshes take
//   peers/QUESTION/CONTESTANT/POSE     what an answer takes, over n rounds, and what it says
//   turned/QUESTION/CONTESTANT/POSE    the same poses, with both meshes in turned frames
//   cold/QUESTION/CONTESTANT/POSE      the same poses, with cold caches
//   points/distances/LIBRARY/POSE      how far the vertices within 2 mm are from the other body
//   worlds/ARRANGEMENT/LIBRARY         a world of a thousand balls that share one structure
//   avx2/QUESTION/CONTESTANT/POSE      the closing, asked of IST with AVX2 alone, where it has more
//
//   IST_PEERS_SECONDS   for how long each question of `peers` is asked, at least 5 rounds; by
//                       default 55. What follows takes two thirds of that together
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <string_view>
#include <vector>

#include "ist/base/parallel.h"
#include "ist/mesh/mesh.h"
#include "peers/contest.h"
#include "peers/libraries.h"
#include "peers/peer.h"
#include "peers/points.h"
#include "peers/poses.h"
#include "peers/worlds.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/latencies.h"
#include "support/peak_memory.h"

namespace ist::bench {
namespace {

// Degrees by which each mesh is turned.
inline constexpr double kFixedTurned = 46, kMovingTurned = 52;

// The same bodies in other frames: each mesh turned about an oblique axis of its own, by
// kFixedTurned and kMovingTurned, its vertices rounded to double, and poses that put them where
// peer_poses() do. A scan has the axes of its scanner; here no axis of a box, a voxel or a grid
// lies along a jaw, and no mesh's along the other's. Coordinates are rounded, so that counts may
// differ from those of the meshes as they are given.
struct TurnedPair {
  TriangleMesh fixed, moving;
  std::vector<NamedPose> poses;
};
[[nodiscard]] TurnedPair turned_pair();

Eigen::Isometry3d turn(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()));
}

TriangleMesh turned(TriangleMesh mesh, const Eigen::Isometry3d& by) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = by * vertex;
  return mesh;
}

TurnedPair turned_pair() {
  const Eigen::Isometry3d fixed = turn(kFixedTurned, {1, 2, 3}),
                          moving = turn(kMovingTurned, {-3, 1, 2});
  TurnedPair pair{turned(upper_jaw(), fixed), turned(lower_jaw(), moving), peer_poses()};
  for (NamedPose& pose : pair.poses) {
    pose.label += ", turned";
    pose.truth.reset();  // which is of the vertices before they were rounded
    pose.pose = fixed * pose.pose * moving.inverse();
  }
  return pair;
}

// The cost to make a library's structures of both meshes, with all its contestants, in the
// thread limit that is set.
struct BuildCost {
  Latencies times;     ///< one a build
  double held_mb = 0;  ///< in use by malloc after a build and not before, by mallinfo2
  double grown_mb =
      0;               ///< by which the process is larger in memory, once free pages are given back
  double peak_mb = 0;  ///< by which it is larger at its largest during a build
  int rounds = 0;      ///< as many builds
};

// In arenas, and mapped for large blocks.
double allocated_mb() {
  const struct mallinfo2 info = mallinfo2();
  return 1e-6 * static_cast<double>(info.uordblks + info.hblkhd);
}

// What is in memory now: the peak since a moment ago.
double resident_mb() {
  reset_peak_memory();
  return peak_memory_mb();
}

// Builds `rounds` times, of which the last one is kept.
BuildCost measure_build(const Library& library, int rounds, Peers& built) {
  const TriangleMesh &fixed = upper_jaw(), &moving = lower_jaw();  // read before the time begins
  BuildCost cost;
  for (; cost.rounds < rounds; ++cost.rounds) {
    built.clear();
    const double resident = resident_mb(), allocated = allocated_mb();
    const auto begin = std::chrono::steady_clock::now();
    built = library.make(fixed, moving);
    cost.times.add(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
            .count());
    cost.peak_mb = std::max(cost.peak_mb, peak_memory_mb() - resident);
    cost.held_mb = std::max(cost.held_mb, allocated_mb() - allocated);
    cost.grown_mb = std::max(cost.grown_mb, resident_mb() - resident);
  }
  return cost;
}

constexpr std::size_t kLine = 64;                // bytes
constexpr std::size_t kUnknownCache = 32 << 20;  // bytes, where no size is told

// Going through memory takes longer than most answers, so not all are asked.
constexpr std::array<std::string_view, 5> kAsked = {"ist", "fcl", "fcl_within", "embree",
                                                    "embree_boxes"};

using Memory = std::vector<unsigned char>;

class ColdPeer final : public Peer {
 public:
  ColdPeer(Peer& peer, std::shared_ptr<Memory> memory)
      : Peer(peer.name(), peer.guarantee()), peer_(peer), memory_(std::move(memory)) {}

  [[nodiscard]] bool answers(Question question) const override { return peer_.answers(question); }
  void prepare(const Eigen::Isometry3d& pose) override {
    peer_.prepare(pose);
    for (std::size_t i = 0; i < memory_->size(); i += kLine) ++(*memory_)[i];
    benchmark::ClobberMemory();
  }
  [[nodiscard]] bool prepared() const override { return peer_.prepared(); }
  bool meets(const Eigen::Isometry3d& pose) override { return peer_.meets(pose); }
  std::uint64_t pairs(const Eigen::Isometry3d& pose) override { return peer_.pairs(pose); }
  std::uint64_t candidates(const Eigen::Isometry3d& pose) override {
    return peer_.candidates(pose);
  }
  DistanceInterval distance(const Eigen::Isometry3d& pose) override { return peer_.distance(pose); }

 private:
  Peer& peer_;
  const std::shared_ptr<Memory> memory_;
};

// Memory that is gone through so that no cache keeps anything of a question: twice the last
// level's size, bytes; little where it is quick().
std::size_t swept_bytes() {
  if (quick()) return 1 << 20;
  int largest = 0;
  for (const auto& cache : benchmark::CPUInfo::Get().caches) {
    largest = std::max(largest, cache.size);
  }
  return 2 * (largest > 0 ? static_cast<std::size_t>(largest) : kUnknownCache);
}

// The quickest of `all`, IST first, under their own names, each with caches as they are when
// something else has used them: before each question swept_bytes() are gone through, outside of
// the time that is taken. `all` must outlive them.
Peers cold_peers(const Peers& all) {
  const auto memory = std::make_shared<Memory>(swept_bytes());
  Peers cold;
  for (const auto& peer : all) {
    if (std::ranges::find(kAsked, peer->name()) == kAsked.end()) continue;
    cold.push_back(std::make_unique<ColdPeer>(*peer, memory));
  }
  return cold;
}

// Who is asked what where; all must outlive the benchmarks.
struct Series {
  std::string name;
  std::vector<Peer*> players;  // the first is IST
  std::vector<NamedPose> poses;
  double part;  // of the time of a question
};

double seconds_a_question() {
  const char* seconds = std::getenv("IST_PEERS_SECONDS");
  if (seconds != nullptr) return std::atof(seconds);
  return quick() ? 1 : 55;
}

void report_build(benchmark::State& state, BuildCost& cost, const std::string& version) {
  for (auto _ : state) state.SetIterationTime(1e-6 * cost.times.quantile(0.5));
  state.counters["p50_us"] = cost.times.quantile(0.5);
  state.counters["max_us"] = cost.times.quantile(1);
  state.counters["n"] = cost.rounds;
  state.counters["held_mb"] = cost.held_mb;
  state.counters["grown_mb"] = cost.grown_mb;
  state.counters["peak_mb"] = cost.peak_mb;
  state.SetLabel(version);
}

// What anybody said, beside what IST did.
void report_answer(benchmark::State& state, Question question, const Answer& ist,
                   const Answer& answer) {
  switch (question) {
    case Question::kMeets:
      state.counters["meets"] = answer.meets ? 1 : 0;
      state.counters["missed"] = ist.meets && !answer.meets ? 1 : 0;
      state.counters["false_touch"] = answer.meets && !ist.meets ? 1 : 0;
      break;
    case Question::kPairs:
    case Question::kCandidates:
      state.counters["pairs"] = static_cast<double>(answer.pairs);
      break;
    case Question::kDistance:
      state.counters["lower"] = answer.gap.lower;
      // Where it is not there, the answer is "farther than `lower`".
      if (std::isfinite(answer.gap.upper)) state.counters["upper"] = answer.gap.upper;
      if (answer.apart) state.counters["points_apart"] = *answer.apart;
      break;
  }
}

void report(benchmark::State& state, Contest& contest, double part, std::size_t index,
            std::size_t at) {
  contest.hold(part * seconds_a_question(), quick() ? 1 : 5);
  Contest::Player& player = contest.players()[index];
  const NamedPose& pose = contest.poses()[at];
  const Question question = contest.question();
  const Answer &ist = contest.players()[0].answers[at], &answer = player.answers[at];
  const Guarantee guarantee = player.peer.guarantee();
  const bool agrees = agree(question, ist, answer, guarantee);
  if (const auto wrong = untrue(question, ist, pose)) {
    state.SkipWithError(wrong->c_str());
    return;
  }
  if (!agrees && guarantee == Guarantee::kExact) {
    state.SkipWithError("differs from IST, though both are exact");
    return;
  }
  if (!agrees) {
    std::cerr << player.peer.name() << " differs in " << to_string(question) << " at " << pose.label
              << '\n';
  }
  Latencies& latencies = player.latencies[at];
  for (auto _ : state) state.SetIterationTime(1e-6 * latencies.quantile(0.5));
  latencies.report(state);
  state.counters["n"] = player.rounds;
  state.counters["agree"] = agrees ? 1 : 0;
  state.counters["promise"] = static_cast<double>(guarantee);
  state.counters["prepared"] = player.peer.prepared() ? 1 : 0;
  if (pose.truth) state.counters["true_distance"] = pose.truth->distance;
  report_answer(state, question, ist, answer);
  state.SetLabel(pose.label);
}

template <typename Body>
void add_benchmark(const std::string& name, Body body) {
  benchmark::RegisterBenchmark(name.c_str(), body)
      ->Unit(benchmark::kMicrosecond)
      ->UseManualTime()
      ->Iterations(1);
}

void add_contest(const Series& series, Question question) {
  const auto contest = std::make_shared<Contest>(question, series.players, series.poses);
  const std::string prefix = series.name + "/" + to_string(question) + "/";
  for (std::size_t player = 0; player < contest->players().size(); ++player) {
    const std::string name = prefix + contest->players()[player].peer.name() + "/";
    for (std::size_t pose = 0; pose < series.poses.size(); ++pose) {
      add_benchmark(name + series.poses[pose].name,
                    [=, part = series.part](benchmark::State& state) {
                      report(state, *contest, part, player, pose);
                    });
    }
  }
}

void add_series(const Series& series) {
  for (const Question question : kQuestions) add_contest(series, question);
}

std::vector<Peer*> pointers(const Peers& peers) {
  std::vector<Peer*> all;
  for (const auto& peer : peers) all.push_back(peer.get());
  return all;
}

// Every library's contestants of both jaws, with a benchmark of what it took to make them.
Peers build_measured() {
  Peers all;
  for (const Library& library : libraries()) {
    Peers built;
    auto cost = std::make_shared<BuildCost>(measure_build(library, quick() ? 1 : 3, built));
    std::move(built.begin(), built.end(), std::back_inserter(all));
    add_benchmark("peers/build/" + library.name,
                  [cost, version = library.version](benchmark::State& state) {
                    report_build(state, *cost, version);
                  });
  }
  return all;
}

Peers build(const TurnedPair& pair) {
  Peers all;
  for (const Library& library : libraries()) {
    Peers built = library.make(pair.fixed, pair.moving);
    std::move(built.begin(), built.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace
}  // namespace ist::bench

int main(int argc, char** argv) {
  using namespace ist::bench;
  benchmark::AddCustomContext("missing_peers", missing_libraries());
  benchmark::AddCustomContext("voxel_size", std::to_string(voxel_size()));
  benchmark::AddCustomContext("pair", pair_name());
  benchmark::AddCustomContext("peer_flags", library_flags());
  benchmark::AddCustomContext("tolerance", fmt::format("{:g}", kTolerance));
  benchmark::AddCustomContext("turned_degrees",
                              fmt::format("{:g} {:g}", kFixedTurned, kMovingTurned));
  benchmark::AddCustomContext("swept_mb", std::to_string(swept_bytes() / 1'000'000));
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  const ist::ScopedThreadLimit one(1);
  const Peers all = build_measured();
  const TurnedPair turned = turned_pair();
  const Peers all_turned = build(turned);
  const Peers all_cold = cold_peers(all);
  const std::unique_ptr<Peer> avx2 = ist_on(*all.front(), "avx2");
  std::vector<Series> asked = {{"peers", pointers(all), peer_poses(), 1},
                               {"turned", pointers(all_turned), turned.poses, 0.3},
                               {"cold", pointers(all_cold), peer_poses(), 0.3}};
  if (avx2) asked.push_back({"avx2", {all.front().get(), avx2.get()}, closing_poses(), 0.1});
  for (const Series& each : asked) add_series(each);
  add_points(seconds_a_question());
  add_worlds(seconds_a_question());
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
