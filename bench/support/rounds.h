#pragma once

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "ist/query/results.h"
#include "support/latencies.h"

namespace ist::bench {

/// A way to ask for contacts that is measured beside others.
struct AxisDirection {
  std::string name;
  std::string answers;  ///< ways with the same word here find as many contacts
  std::function<QueryResult(const Eigen::Isometry3d&)> ask;
};

/// A pose, and what it is called in the benchmark's name.
struct Place {
  std::string name;
  Eigen::Isometry3d pose;
};

/// Several ways, each asked all poses one after the other, turn and turn about: so no pose is asked
/// twice in a row, and all meet the machine as it is at the time. A turn begins with a round that
/// is not timed, for the way before has left its own bodies in the caches. Ends the program where
/// an answer is not whole, another than the turn before, or another than it should be.
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

}  // namespace ist::bench
