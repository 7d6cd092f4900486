#include "measure/by_accuracy.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <functional>
#include <map>
#include <vector>

#include "ist/base/parallel.h"
#include "ist/measure/penetration.h"
#include "ist/query/query.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/latencies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

using Pose = Eigen::Isometry3d;

constexpr double kVoxelSize = 0.4;  // no answer about triangles depends on it
constexpr double kRounding = 2e-6;  // mm

struct Interval {
  double lower, upper;
  bool complete;
};

// How a question is asked: at a pose, to within a tolerance.
using Ask = std::function<Interval(Query&, const Pose&, double)>;

Interval touch(Query& query, const Pose& pose, double) {
  const Answer answer = query.intersects(pose).answer;
  const double yes = answer == Answer::kYes ? 1 : 0;
  return {yes, yes, answer == Answer::kYes || answer == Answer::kNo};
}

Interval distance(Query& query, const Pose& pose, double tolerance) {
  const auto result = query.distance(pose, tolerance);
  return {result.distance.lower, result.distance.upper, result.complete};
}

Interval depth(Query& query, const Pose& pose, double tolerance) {
  const Penetration found = penetration(query, pose, tolerance);
  return {found.lower, found.upper, found.complete && found.status == Penetration::Status::kDone};
}

std::vector<double> tolerances() {
  if (quick()) return {0.1, 0.01};
  return {1, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001};
}

struct Question {
  const char* name;
  Ask ask;
};

void measure(benchmark::State& state, const Question& question, double tolerance, double dz) {
  const ScopedThreadLimit one(1);
  const auto& [fixed, moving] = triangle_trees(kVoxelSize);
  Query query(fixed, moving);
  const Pose pose = closing(dz);
  const Interval finest = question.ask(query, pose, tolerances().back());
  const int turns = rounds(31);
  Latencies times;
  Interval found{};
  for (auto _ : state) {
    for (int turn = 0; turn < turns; ++turn) {
      query.forget();
      const Stopwatch watch;
      found = question.ask(query, pose, tolerance);
      times.add(watch.microseconds());
    }
    state.SetIterationTime(1e-6 * times.quantile(0.5));
  }
  if (!found.complete) {
    state.SkipWithError("an answer is not complete");
    return;
  }
  if (found.lower > finest.upper + kRounding || found.upper < finest.lower - kRounding) {
    state.SkipWithError("an interval does not hold what the finest tolerance found");
    return;
  }
  times.report(state);
  state.counters["lower"] = found.lower;
  state.counters["upper"] = found.upper;
  state.counters["n"] = turns;
  state.SetLabel(pair_name());
}

void add(const Question& question, double tolerance) {
  for (const double dz : kClosing) {
    benchmark::RegisterBenchmark(
        fmt::format("by_accuracy/{}/{:g}/{:g}", question.name, tolerance, dz).c_str(),
        [=](benchmark::State& state) { measure(state, question, tolerance, dz); })
        ->Unit(benchmark::kMicrosecond)
        ->UseManualTime()
        ->Iterations(1);
  }
}

}  // namespace

void add_by_accuracy() {
  add({"touch", touch}, 0);
  for (const double tolerance : tolerances()) {
    add({"distance", distance}, tolerance);
    add({"depth", depth}, tolerance);
  }
}

}  // namespace ist::bench
