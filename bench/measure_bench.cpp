// Measures that may take milliseconds, and beside each the distance of the surfaces, of which it is
// said how many go into its time.
//
//   measure/distances/POSE          both bodies' vertices within 2 mm, afresh
//   measure/distance/POSE           of the surfaces, to 0.05 mm, afresh
//   measure/depth/cold|warm/POSE    to 0.01 mm; warm from the answer 0.02 mm away
//   measure/depth/balls/POSE        cold by outer balls, and without them in turn: both medians
//   measure/depth/carried/HOW/STEP  by a tracker: sliding or lifting by STEP µm a question
//   measure/outer_balls/upper|lower made once a tree
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
benchmark::internal::Benchmark* registered(const std::string& name, const Body& body) {
  return benchmark::RegisterBenchmark(name.c_str(),
                                      [=](benchmark::State& state) {
                                        const ScopedThreadLimit one(1);
                                        body(state);
                                        state.SetLabel(pair_name());
                                      })
      ->Unit(benchmark::kMicrosecond);
}

template <class Body>
void add(const std::string& name, const Body& body) {
  registered(name, body)->UseRealTime();
}

template <class Body>
void add_manual(const std::string& name, const Body& body) {
  registered(name, body)->UseManualTime()->Iterations(1);
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

// The same bodies as triangle_trees(), with outer balls.
const std::pair<SphereTree, SphereTree>& prepared_trees() {
  static const std::pair<SphereTree, SphereTree> trees = [] {
    std::pair made(build_tree(upper_jaw()), build_tree(lower_jaw()));
    prepare_depth(made.first);
    prepare_depth(made.second);
    return made;
  }();
  return trees;
}

// Asks with and without balls in turn. Each question is asked twice, and the second time counts:
// the other one has emptied the caches.
void depth_by_balls(benchmark::State& state, const Eigen::Isometry3d& pose) {
  const auto& [fixed, moving] = prepared_trees();
  Query plain = make_query(), prepared(fixed, moving);
  Latencies by_points, by_balls;
  Penetration found, without;
  const auto ask = [&](Query& query, Latencies& times) {
    static_cast<void>(penetration(query, pose, kDepth));
    const Stopwatch watch;
    const Penetration answer = penetration(query, pose, kDepth);
    times.add(watch.microseconds());
    return answer;
  };
  for (auto _ : state) {
    for (int turn = 0; turn < rounds(31); ++turn) {
      without = ask(plain, by_points);
      found = ask(prepared, by_balls);
    }
    state.SetIterationTime(1e-6 * by_balls.quantile(0.5));
  }
  if (found.lower > without.upper || found.upper < without.lower) {
    state.SkipWithError("the intervals with and without balls do not overlap");
    return;
  }
  state.counters["without"] = by_points.quantile(0.5);
  state.counters["ratio"] = by_points.quantile(0.5) / by_balls.quantile(0.5);
  state.counters["points"] = static_cast<double>(found.points);
  state.counters["points_without"] = static_cast<double>(without.points);
}

void depth_carried(benchmark::State& state, const Eigen::Vector3d& from, const Eigen::Vector3d& way,
                   double step) {
  const auto& [fixed, moving] = prepared_trees();
  Query query(fixed, moving);
  constexpr double kAmplitude = 1.5;  // mm, to and fro
  const int ticks = quick() ? 50 : 500;
  Latencies times;
  std::uint64_t points = 0;
  for (auto _ : state) {
    DepthTracker tracker;
    for (int tick = 0; tick <= ticks; ++tick) {
      const double gone = std::fmod(tick * step, 2 * kAmplitude);
      const double there = kAmplitude - std::abs(gone - kAmplitude);
      const Eigen::Isometry3d pose(Eigen::Translation3d(from + there * way));
      const Stopwatch watch;
      const Penetration found = penetration(query, pose, kDepth, {.tracker = &tracker});
      if (tick == 0) continue;  // cold
      times.add(watch.microseconds());
      points += found.points;
    }
    state.SetIterationTime(1e-6 * times.quantile(0.5));
  }
  times.report(state);
  state.counters["points"] = static_cast<double>(points) / ticks;
}

void outer_balls(benchmark::State& state, const TriangleMesh& mesh) {
  for (auto _ : state) {
    state.PauseTiming();
    const SphereTree tree = build_tree(mesh);
    static_cast<void>(tree.self_intersections());
    const std::uint64_t before = tree.bytes();
    state.ResumeTiming();
    prepare_depth(tree);
    state.counters["bytes_a_triangle"] =
        static_cast<double>(tree.bytes() - before) / static_cast<double>(mesh.triangles.size());
  }
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
    add_manual(fmt::format("measure/depth/balls/{}", dz),
               [=](auto& state) { depth_by_balls(state, pose); });
    add(fmt::format("measure/occlusion/{}", dz), [=](auto& state) { bite(state, pose); });
  }
  add("measure/first_contact/closing",
      [](auto& state) { first(state, Motion::between(lifted(-7), lifted(0))); });
  add("measure/first_contact/screw", [](auto& state) {
    first(state, Motion::screw(lifted(-7), {0, 0, 0}, {0, 0.1, 1}, 0.05, 7));
  });
  for (const double microns : {2.0, 10.0, 30.0}) {
    const double step = 1e-3 * microns;
    add_manual(fmt::format("measure/depth/carried/sliding/{}", microns), [=](auto& state) {
      depth_carried(state, {0, 0, -0.5}, {1, 0.1, 0}, step);
    });
    add_manual(fmt::format("measure/depth/carried/lifting/{}", microns), [=](auto& state) {
      depth_carried(state, {0, 0, -0.2}, {0, 0, -1}, step);
    });
  }
  add("measure/outer_balls/upper", [](auto& state) { outer_balls(state, upper_jaw()); });
  add("measure/outer_balls/lower", [](auto& state) { outer_balls(state, lower_jaw()); });
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
