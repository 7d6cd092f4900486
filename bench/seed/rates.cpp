#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/query/results.h"
#include "ist/tree/tree_parts.h"
#include "seed/sections.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/latencies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

// A way to ask for contacts that is measured beside others.
struct AxisDirection {
  std::string name;
  std::string answers;  ///< ways with the same word here find as many contacts
  std::function<QueryResult(const Eigen::Isometry3d&)> ask;
};

// A pose, and what it is called in the benchmark's name.
struct Place {
  std::string name;
  Eigen::Isometry3d pose;
};

// Several ways, each asked all poses one after the other, turn and turn about: so no pose is asked
// twice in a row, and all meet the machine as it is at the time. A turn begins with a round that
// is not timed, for the way before has left its own bodies in the caches. Ends the program where
// an answer is not whole, another than the turn before, or another than it should be.
class Rounds {
 public:
  /// Makes the ways when it is first measured, so that what is not asked for is not built.
  using Make = std::function<std::vector<AxisDirection>()>;
  Rounds(std::vector<Place> places, Make make, int turns)
      : places_(std::move(places)), make_(std::move(make)), turns_(turns) {}

  /// Registers a benchmark PREFIX/way/place for each. `more` may add counters.
  using More = std::function<void(benchmark::State&, const QueryResult&)>;
  static void add(const std::string& prefix, const std::vector<std::string>& ways,
                  std::vector<Place> places, const Make& make, int turns, const More& more = {});

 private:
  struct Measured {
    std::string name, answers;
    std::vector<Latencies> latencies;  // by place
    std::vector<QueryResult> results;
  };
  void measure();
  void check(const Measured& measured, std::size_t place, const QueryResult& result) const;
  void report(benchmark::State& state, const std::string& way, std::size_t place, const More& more);

  std::vector<Place> places_;
  Make make_;
  int turns_;
  std::vector<Measured> measured_;
};

void Rounds::check(const Measured& measured, std::size_t place, const QueryResult& result) const {
  bool good = result.status == QueryStatus::kDone && result.complete && !result.truncated;
  for (const Measured& other : measured_) {
    const bool asked = other.latencies[place].size() > 0;
    if (!asked || other.answers != measured.answers) continue;
    good = good && other.results[place].leaf_pairs == result.leaf_pairs;
  }
  if (good) return;
  std::cerr << measured.name << " is wrong at " << places_[place].name << '\n';
  std::exit(1);
}

void Rounds::measure() {
  const std::vector<AxisDirection> ways = make_();
  for (const AxisDirection& way : ways) {
    measured_.push_back({way.name, way.answers, std::vector<Latencies>(places_.size()),
                         std::vector<QueryResult>(places_.size())});
  }
  for (int turn = 0; turn < turns_; ++turn) {
    for (std::size_t i = 0; i < ways.size(); ++i) {
      for (const Place& place : places_) static_cast<void>(ways[i].ask(place.pose));
      for (std::size_t place = 0; place < places_.size(); ++place) {
        const Stopwatch watch;
        const QueryResult result = ways[i].ask(places_[place].pose);
        const double time = watch.microseconds();
        check(measured_[i], place, result);
        measured_[i].latencies[place].add(time);
        measured_[i].results[place] = result;
      }
    }
  }
}

void Rounds::report(benchmark::State& state, const std::string& way, std::size_t place,
                    const More& more) {
  for (auto _ : state) {
    if (measured_.empty()) measure();
    const auto of_way = std::find_if(measured_.begin(), measured_.end(),
                                     [&](const Measured& m) { return m.name == way; });
    if (of_way == measured_.end()) {
      state.SkipWithError("nobody asks in this way");
      return;
    }
    const QueryResult& result = of_way->results[place];
    Latencies& latencies = of_way->latencies[place];
    state.SetIterationTime(1e-6 * latencies.quantile(0.5));
    latencies.report(state);
    state.counters["n"] = static_cast<double>(latencies.size());
    state.counters["contacts"] = static_cast<double>(result.leaf_pairs);
    state.counters["tests"] = static_cast<double>(result.sphere_tests);
    if (more) more(state, result);
  }
}

void Rounds::add(const std::string& prefix, const std::vector<std::string>& ways,
                 std::vector<Place> places, const Make& make, int turns, const More& more) {
  const auto rounds = std::make_shared<Rounds>(places, make, turns);
  for (const std::string& way : ways) {
    for (std::size_t place = 0; place < places.size(); ++place) {
      const std::string name = prefix + "/" + way + "/" + places[place].name;
      benchmark::RegisterBenchmark(
          name.c_str(), [=](benchmark::State& state) { rounds->report(state, way, place, more); })
          ->Unit(benchmark::kMicrosecond)
          ->UseManualTime()
          ->Iterations(1);
    }
  }
}

constexpr std::size_t kContacts = 1 << 20;

template <class Query, class... Options>
AxisDirection way(const std::string& name, const std::string& answers, double voxel_size,
                  const Options&... options) {
  const auto& [fixed, moving] = trees(voxel_size);
  const auto query = std::make_shared<Query>(fixed, moving, options...);
  const auto leaf_pairs = std::make_shared<std::vector<LeafPair>>(kContacts);
  return {name, answers,
          [=](const Eigen::Isometry3d& pose) { return query->leaf_pairs(pose, *leaf_pairs); }};
}

Place at(double distance) { return {fmt::format("{:g}", distance), closing(-distance)}; }

// The article's first proposal: spheres that are saved, against spheres made at each visit.
void add_saved(double voxel_size) {
  constexpr SpherePolicy kImplicit[] = {SpherePolicy::kSimple, SpherePolicy::kTable};
  std::vector<std::string> names;
  for (const SpherePolicy policy : kImplicit) {
    for (const char* source : {"on_the_fly", "saved"}) {
      names.push_back(fmt::format("{}/{}", to_string(policy), source));
    }
  }
  Rounds::add(
      fmt::format("saved/{:g}", voxel_size), names, {at(0), at(1.5)},
      [=] {
        std::vector<AxisDirection> ways;
        for (std::size_t i = 0; i < names.size(); ++i) {
          const SpherePolicy policy = kImplicit[i / 2];
          ways.push_back(
              way<ReferenceQuery>(names[i], std::string(to_string(policy)), voxel_size, policy,
                                  i % 2 == 0 ? SphereSource::kOnTheFly : SphereSource::kSaved));
        }
        return ways;
      },
      rounds(31),
      [=](benchmark::State& state, const QueryResult&) {
        const auto& [fixed, moving] = trees(voxel_size);
        const auto nodes = static_cast<double>(voxels_of(fixed).octree.node_count() +
                                               voxels_of(moving).octree.node_count());
        state.counters["ball_bytes"] = sizeof(Ball);
        state.counters["saved_MB"] = sizeof(Ball) * nodes / 1e6;
        state.counters["octree_MB"] = static_cast<double>(voxels_of(fixed).octree.bytes() +
                                                          voxels_of(moving).octree.bytes()) /
                                      1e6;
      });
}

constexpr double kDistances[] = {0, 0.5, 1, 1.5, 2, 2.5, 3, 4, 5, 7.5, 10, 15, 20, 25, 30, 40, 50};

// Which of the distances is right before collision: the first at which no triangles meet.
void add_before_contact(const std::string& name, double unit) {
  benchmark::RegisterBenchmark(("before_contact/" + name).c_str(), [=](benchmark::State& state) {
    const auto& [fixed, moving] = triangle_trees(0.8);  // triangles meet whatever the voxels
    Query query(fixed, moving);
    const double* apart = nullptr;
    for (auto _ : state) {
      apart = std::ranges::find_if(kDistances, [&](double distance) {
        return query.intersects(closing(-distance * unit)).answer == Answer::kNo;
      });
    }
    if (apart == std::end(kDistances)) {
      state.SkipWithError("the jaws meet at every distance");
      return;
    }
    state.counters["distance"] = *apart;
    state.SetLabel(pair_name());
  })->Iterations(1);
}

// Figure 10: by distance, policy and engine; distances in units of which there are `unit` mm.
void add_rate(const std::string& name, double voxel_size, double unit, int turns) {
  std::vector<Place> places;
  for (const double distance : kDistances) {
    places.push_back({fmt::format("{:g}", distance), closing(-distance * unit)});
  }
  std::vector<std::string> names;
  for (const char* engine : {"reference", "fast"}) {
    for (const SpherePolicy policy : kSpherePolicies) {
      names.push_back(fmt::format("{}/{}", engine, to_string(policy)));
    }
  }
  Rounds::add(
      fmt::format("rate/{}", name), names, places,
      [=] {
        std::vector<AxisDirection> ways;
        for (const SpherePolicy policy : kSpherePolicies) {
          const std::string& of = names[ways.size()];
          ways.push_back(way<ReferenceQuery>(of, of, voxel_size, policy));
        }
        for (const SpherePolicy policy : kSpherePolicies) {
          const std::string& of = names[ways.size()];
          QueryOptions options;
          options.policy = policy;
          ways.push_back(way<Query>(of, of, voxel_size, options));
        }
        return ways;
      },
      turns);
}

}  // namespace

void add_rates() {
  const double unit = published_unit();
  for (const double size : {0.8, 0.2}) {
    add_saved(size);
    add_rate(fmt::format("{:g}", size), size, 1, rounds(size < 0.5 ? 31 : 101));
    add_before_contact(fmt::format("{:g}", size), 1);
    if (quick()) continue;
    add_rate(fmt::format("scaled{:g}", size), size * unit, unit, rounds(31));
    add_before_contact(fmt::format("scaled{:g}", size), unit);
  }
}

}  // namespace ist::bench
