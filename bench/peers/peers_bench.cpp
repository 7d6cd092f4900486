// This library beside others that answer the same questions, in one run, on the closing and on the
// poses whose truth is known; at 0.2 mm where there are voxels, and all in one thread.
//
//   peers/build/LIBRARY                what its structures of both meshes take
//   peers/QUESTION/CONTESTANT/POSE     what an answer takes, over n rounds, and what it says
//
//   IST_PEERS_SECONDS   for how long each question is asked, at least 5 rounds; by default 55
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "ist/base/parallel.h"
#include "peers/build_cost.h"
#include "peers/contest.h"
#include "peers/libraries.h"
#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {
namespace {

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

void report(benchmark::State& state, Contest& contest, std::size_t index, std::size_t at) {
  contest.hold(seconds_a_question(), quick() ? 1 : 5);
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

void add_contest(const std::shared_ptr<Contest>& contest) {
  const std::string question = std::string("peers/") + to_string(contest->question());
  for (std::size_t player = 0; player < contest->players().size(); ++player) {
    const std::string name = question + "/" + contest->players()[player].peer.name() + "/";
    for (std::size_t pose = 0; pose < contest->poses().size(); ++pose) {
      add_benchmark(name + contest->poses()[pose].name,
                    [=](benchmark::State& state) { report(state, *contest, player, pose); });
    }
  }
}

}  // namespace
}  // namespace ist::bench

int main(int argc, char** argv) {
  using namespace ist::bench;
  benchmark::AddCustomContext("missing_peers", missing_libraries());
  benchmark::AddCustomContext("voxel_size", std::to_string(voxel_size()));
  benchmark::AddCustomContext("pair", pair_name());
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  const ist::ScopedThreadLimit one(1);
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
  const std::vector<NamedPose> poses = peer_poses();
  for (const Question question : kQuestions) {
    add_contest(std::make_shared<Contest>(question, all, poses));
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
