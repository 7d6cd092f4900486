// This library beside others that answer the same questions, in one run, on the closing and on the
// poses whose truth is known; at 0.2 mm where there are voxels, and all in one thread.
//
//   peers/build/LIBRARY                what its structures of both meshes take
//   peers/QUESTION/CONTESTANT/POSE     what an answer takes, over n rounds, and what it says
//   turned/QUESTION/CONTESTANT/POSE    the same poses, with both meshes in turned frames
//   cold/QUESTION/CONTESTANT/POSE      the same poses, with cold caches
//   points/distances/LIBRARY/POSE      how far the vertices within 2 mm are from the other body
//   avx2/QUESTION/CONTESTANT/POSE      the closing, asked of IST with AVX2 alone, where it has more
//
//   IST_PEERS_SECONDS   for how long each question of `peers` is asked, at least 5 rounds; by
//                       default 55. What follows takes two thirds of that together
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "ist/base/parallel.h"
#include "peers/build_cost.h"
#include "peers/cold_peers.h"
#include "peers/contest.h"
#include "peers/ist_peer.h"
#include "peers/libraries.h"
#include "peers/points.h"
#include "peers/turned.h"
#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {
namespace {

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
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
