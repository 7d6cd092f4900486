#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "ist/base/api.h"

namespace ist {

/// How long something took, over any number of times: where its quantiles lie, to within 1/32.
///
/// Buckets are log-linear: each octave of nanoseconds, from one power of two to the next, is cut
/// into 32 equal ones, and what lies below 64 ns has a bucket a nanosecond. The 1024 of them reach
/// to 2^36 ns, about 68 s; what is longer goes into the last. 8 KiB, all of it inside the object:
/// nothing here allocates, throws or waits. Not for several threads at once.
///
/// Source of the layout: G. Tene, HdrHistogram: a high dynamic range histogram, hdrhistogram.org.
class IST_API LatencyHistogram {
 public:
  using Nanoseconds = std::chrono::nanoseconds;

  /// A negative time counts as 0. Cost: a few nanoseconds, whatever the time.
  void record(Nanoseconds time) noexcept;
  /// As if all that `other` recorded had been recorded here. Cost: one look at each bucket.
  void merge(const LatencyHistogram& other) noexcept;
  void clear() noexcept { *this = LatencyHistogram(); }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// The longest, exact. 0 where there is none.
  [[nodiscard]] Nanoseconds max() const noexcept {
    return Nanoseconds(static_cast<std::int64_t>(max_));
  }
  /// Rounded down to a nanosecond; of the times themselves, not of buckets. 0 where there is none;
  /// too small once all times together pass 584 years.
  [[nodiscard]] Nanoseconds mean() const noexcept;

  /// The shortest time t such that at least q · count() of the times are no longer than t (and at
  /// least one is), rounded up to its bucket's end, and never above max(): so it is never too
  /// small, too large by at most t/32, and exact below 64 ns. Where t is in the last bucket, from
  /// 63/64 · 2^36 ns on, it is max(). 0 where there is none. Cost: one look at each bucket.
  ///
  /// Precondition: q in [0, 1].
  [[nodiscard]] Nanoseconds quantile(double q) const noexcept;

  /// How many times are no longer than `time`, all of its bucket among them. Cost: one look at each
  /// bucket.
  [[nodiscard]] std::uint64_t count_upto(Nanoseconds time) const noexcept;

 private:
  static constexpr unsigned kSubBits = 5;  // 32 buckets an octave
  static constexpr unsigned kTimeBits = 36;
  static constexpr std::size_t kBuckets = std::size_t{kTimeBits - kSubBits + 1} << kSubBits;

  IST_LOCAL static std::size_t bucket_of(std::uint64_t time) noexcept;
  IST_LOCAL static std::uint64_t last_of(std::size_t bucket) noexcept;
  IST_LOCAL void add_to_sum(std::uint64_t time) noexcept;

  std::array<std::uint64_t, kBuckets> counts_{};
  std::uint64_t count_ = 0, sum_ = 0, max_ = 0;
};

}  // namespace ist
