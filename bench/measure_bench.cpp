// Measures that may take milliseconds, and beside each the distance of the surfaces, of which it is
// said how many go into its time.
//
//   measure/distances/POSE          both bodies' vertices within 2 mm, afresh
//   measure/distance/POSE           of the surfaces, to 0.05 mm, afresh
//   measure/depth/cold|warm/POSE    to 0.01 mm; warm from the answer 0.02 mm away
//   measure/first_contact/MOTION    to 1 µm
//   measure/occlusion/POSE          all of it
//   measure/normals/upper|lower     made once a tree
//   by_accuracy/…                   touch, distance and depth by tolerance
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "ist/base/parallel.h"
#include "ist/measure/first_contact.h"
#include "ist/measure/occlusion.h"
#include "ist/measure/penetration.h"
#include "ist/measure/signed_distance.h"
#include "ist/mesh/pseudonormals.h"
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

// by_accuracy/touch/0/POSE, by_accuracy/distance/TOLERANCE/POSE and
// by_accuracy/depth/TOLERANCE/POSE: what exact touch, the distance and the depth take, each
// afresh, and how wide their intervals are. An interval that does not hold what the finest
// tolerance found ends the benchmark.
void add_by_accuracy() {
  add({"touch", touch}, 0);
  for (const double tolerance : tolerances()) {
    add({"distance", distance}, tolerance);
    add({"depth", depth}, tolerance);
  }
}

constexpr double kReach = 2, kDepth = 0.01, kContact = 1e-3;  // mm

Query make_query() {
  const auto& [fixed, moving] = triangle_trees(kVoxelSize);
  return Query(fixed, moving);
}

Eigen::Isometry3d lifted(double dz) { return Eigen::Isometry3d(Eigen::Translation3d(0, 0, dz)); }

template <class Body>
void add(const std::string& name, const Body& body) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 const ScopedThreadLimit one(1);
                                 body(state);
                                 state.SetLabel(pair_name());
                               })
      ->Unit(benchmark::kMicrosecond)
      ->UseRealTime();
}

void distances(benchmark::State& state, const Eigen::Isometry3d& pose) {
  const auto& [fixed, moving] = triangle_trees(kVoxelSize);
  std::size_t near = 0;
  for (auto _ : state) {
    near = 0;
    for (const auto& map : {distance_map(moving, fixed, pose, kReach),
                            distance_map(fixed, moving, pose.inverse(), kReach)}) {
      for (const SurfaceDistance& one : map) near += std::isnan(one.distance) ? 0U : 1U;
    }
  }
  state.counters["near"] = static_cast<double>(near);
  state.counters["reach"] = kReach;
}

void depth(benchmark::State& state, const Eigen::Isometry3d& pose, bool warm) {
  Query query = make_query();
  const Penetration before = penetration(query, lifted(-0.02) * pose, kDepth);
  Penetration found;
  for (auto _ : state) {
    found = penetration(query, pose, kDepth, {.last = warm ? &before : nullptr});
  }
  state.counters["tolerance"] = kDepth;
  state.counters["points"] = static_cast<double>(found.points);
  state.counters["lower"] = found.lower;
  state.counters["upper"] = found.upper;
}

void first(benchmark::State& state, const Motion& motion) {
  Query query = make_query();
  FirstContact found;
  for (auto _ : state) found = first_contact(query, motion, kContact);
  state.counters["tolerance"] = kContact;
  state.counters["distances"] = static_cast<double>(found.distances);
  state.counters["verdicts"] = static_cast<double>(found.verdicts);
  state.counters["upper"] = found.upper;
}

void bite(benchmark::State& state, const Eigen::Isometry3d& pose) {
  const Query query = make_query();
  Occlusion found;
  for (auto _ : state) found = occlusion(query, pose);
  state.counters["regions"] = static_cast<double>(found.moving.regions.size());
  state.counters["area"] = found.moving.penetrating_area;
}

void normals(benchmark::State& state, const TriangleMesh& mesh) {
  for (auto _ : state) benchmark::DoNotOptimize(Pseudonormals(mesh));
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
}

const int kRegistered = [] {
  for (const double dz : kClosing) {
    const Eigen::Isometry3d pose = closing(dz);
    add(fmt::format("measure/distances/{}", dz), [=](auto& state) { distances(state, pose); });
    add(fmt::format("measure/distance/{}", dz), [=](benchmark::State& state) {
      Query query = make_query();
      for (auto _ : state) {
        query.forget();
        benchmark::DoNotOptimize(query.distance(pose, 0.05));
      }
    });
    add(fmt::format("measure/depth/cold/{}", dz), [=](auto& state) { depth(state, pose, false); });
    add(fmt::format("measure/depth/warm/{}", dz), [=](auto& state) { depth(state, pose, true); });
    add(fmt::format("measure/occlusion/{}", dz), [=](auto& state) { bite(state, pose); });
  }
  add("measure/first_contact/closing",
      [](auto& state) { first(state, Motion::between(lifted(-7), lifted(0))); });
  add("measure/first_contact/screw", [](auto& state) {
    first(state, Motion::screw(lifted(-7), {0, 0, 0}, {0, 0.1, 1}, 0.05, 7));
  });
  add("measure/first_contact/short",
      [](auto& state) { first(state, Motion::between(lifted(-1.4), lifted(-1.2))); });
  add("measure/first_contact/opening",
      [](auto& state) { first(state, Motion::between(lifted(-1.4), lifted(-20))); });
  add("measure/normals/upper", [](auto& state) { normals(state, upper_jaw()); });
  add("measure/normals/lower", [](auto& state) { normals(state, lower_jaw()); });
  add_by_accuracy();
  return 0;
}();

}  // namespace
}  // namespace ist::bench
