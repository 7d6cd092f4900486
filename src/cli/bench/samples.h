#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace ist::cli {

/// The times of single queries, microseconds.
class Samples {
 public:
  void add(double microseconds) { times_.push_back(microseconds); }

  [[nodiscard]] std::size_t size() const { return times_.size(); }
  [[nodiscard]] bool empty() const { return times_.empty(); }

  /// Returns the time that this part of all queries, 0 to 1, did not exceed. Precondition: not
  /// empty. Cost: linear in the samples.
  [[nodiscard]] double quantile(double part) const {
    std::vector<double> times = times_;
    const auto last = static_cast<double>(times.size() - 1);
    const auto at = times.begin() + std::lround(part * last);
    std::nth_element(times.begin(), at, times.end());
    return *at;
  }
  [[nodiscard]] double median() const { return quantile(0.5); }

 private:
  std::vector<double> times_;
};

}  // namespace ist::cli
