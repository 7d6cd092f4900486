#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "ist/base/api.h"

namespace ist {

/// A histogram of durations, with quantiles to within 1/32. Used by one thread at a time.
///
/// Buckets are log-linear: each octave of nanoseconds has 32 equal buckets; below 64 ns each
/// nanosecond has its own. 1024 buckets reach to 2^36 ns, about 68 s; the last one takes all longer
/// durations. The object has 8 KiB and allocates nothing. Source of the layout: G. Tene,
/// HdrHistogram: a high dynamic range histogram, hdrhistogram.org.
class IST_API LatencyHistogram {
 public:
  /// The unit of durations.
  using Nanoseconds = std::chrono::nanoseconds;

  /// Records a duration; a negative one counts as 0. Cost: a few nanoseconds.
  void record(Nanoseconds time) noexcept;
  /// Adds all durations that `other` recorded. Cost: one read of each bucket.
  void merge(const LatencyHistogram& other) noexcept;
  /// Forgets all durations.
  void clear() noexcept { *this = LatencyHistogram(); }

  /// The number of durations.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// The longest duration, exact; 0 if the histogram is empty.
  [[nodiscard]] Nanoseconds max() const noexcept {
    return Nanoseconds(static_cast<std::int64_t>(max_));
  }
  /// The mean of the durations, rounded down to a nanosecond; 0 if the histogram is empty. Too
  /// small once their sum passes 584 years.
  [[nodiscard]] Nanoseconds mean() const noexcept;

  /// The shortest duration t such that at least q · count() durations, and at least one, are no
  /// longer than t; rounded up to the end of its bucket, and at most max(). It is never too small,
  /// too large by at most t/32, and exact below 64 ns. In the last bucket, from 63/64 · 2^36 ns on,
  /// it is max(). 0 if the histogram is empty. `q` is limited to [0, 1]; NaN counts as 0. Cost: one
  /// read of each bucket.
  [[nodiscard]] Nanoseconds quantile(double q) const noexcept;

  /// The number of durations that are no longer than `time`, including all of its bucket. Cost: one
  /// read of each bucket.
  [[nodiscard]] std::uint64_t count_upto(Nanoseconds time) const noexcept;

 private:
  static constexpr std::size_t kBuckets = 1024;

  std::array<std::uint64_t, kBuckets> counts_{};
  std::uint64_t count_ = 0, sum_ = 0, max_ = 0;
};

}  // namespace ist
