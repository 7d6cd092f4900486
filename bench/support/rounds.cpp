#include "support/rounds.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>

#include "support/stopwatch.h"

namespace ist::bench {

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

}  // namespace ist::bench
