#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace ist::bench {

/// Times of single queries, µs.
class Latencies {
 public:
  void add(double microseconds) { times_.push_back(microseconds); }

  [[nodiscard]] std::size_t size() const { return times_.size(); }

  /// The time that a part of all queries did not exceed. Precondition: there is one.
  [[nodiscard]] double quantile(double part) {
    std::sort(times_.begin(), times_.end());
    const auto last = static_cast<double>(times_.size() - 1);
    return times_[static_cast<std::size_t>(part * last + 0.5)];
  }

  /// p50_us, p99_us, p99.9_us and max_us, with something before.
  void report(benchmark::State& state, const std::string& prefix = "") {
    state.counters[prefix + "p50_us"] = quantile(0.5);
    state.counters[prefix + "p99_us"] = quantile(0.99);
    state.counters[prefix + "p99.9_us"] = quantile(0.999);
    state.counters[prefix + "max_us"] = quantile(1);
  }

 private:
  std::vector<double> times_;
};

}  // namespace ist::bench
