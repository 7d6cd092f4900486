#include "ist/haptics/latency_histogram.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "ist/base/float_environment.h"

namespace ist {
namespace {

constexpr unsigned kSubBits = 5;  // 32 buckets an octave
constexpr unsigned kTimeBits = 36;
constexpr std::size_t kLastBucket = (std::size_t{kTimeBits - kSubBits + 1} << kSubBits) - 1;

// A time shifted right by its octave is in [32, 64), or less in octave 0. The sum octave · 32 +
// shifted time has no holes: octave · 32 rises where the shifted time falls back from 64 to 32.
std::size_t bucket_of(std::uint64_t time) noexcept {
  const unsigned bits = 64u - static_cast<unsigned>(std::countl_zero(time));
  const unsigned octave = bits > kSubBits + 1 ? bits - (kSubBits + 1) : 0;
  const std::size_t bucket = (std::size_t{octave} << kSubBits) + (time >> octave);
  return std::min(bucket, kLastBucket);
}

// The longest time of a bucket.
std::uint64_t last_of(std::size_t bucket) noexcept {
  const std::size_t octave = std::max<std::size_t>(bucket >> kSubBits, 1) - 1;
  return ((std::uint64_t{bucket} - (octave << kSubBits) + 1) << octave) - 1;
}

std::uint64_t limited_sum(std::uint64_t a, std::uint64_t b) noexcept {
  return a + std::min(b, std::numeric_limits<std::uint64_t>::max() - a);
}

}  // namespace

void LatencyHistogram::record(Nanoseconds time) noexcept {
  static_assert(kLastBucket + 1 == kBuckets);
  const auto ns = static_cast<std::uint64_t>(std::max(time.count(), Nanoseconds::rep{0}));
  ++counts_[bucket_of(ns)];
  ++count_;
  sum_ = limited_sum(sum_, ns);
  max_ = std::max(max_, ns);
}

void LatencyHistogram::merge(const LatencyHistogram& other) noexcept {
  for (std::size_t i = 0; i < kBuckets; ++i) counts_[i] += other.counts_[i];
  count_ += other.count_;
  sum_ = limited_sum(sum_, other.sum_);
  max_ = std::max(max_, other.max_);
}

LatencyHistogram::Nanoseconds LatencyHistogram::mean() const noexcept {
  return Nanoseconds(count_ == 0 ? 0 : static_cast<std::int64_t>(sum_ / count_));
}

LatencyHistogram::Nanoseconds LatencyHistogram::quantile(double q) const noexcept {
  const ScopedFloatEnvironment environment;
  const double rank = std::max(1.0, q * static_cast<double>(count_));  // 1 if q is NaN
  std::uint64_t seen = 0;
  for (std::size_t bucket = 0; bucket + 1 < kBuckets; ++bucket) {
    seen += counts_[bucket];
    if (static_cast<double>(seen) >= rank) {
      return Nanoseconds(static_cast<std::int64_t>(std::min(last_of(bucket), max_)));
    }
  }
  return max();  // the last bucket has no end
}

std::uint64_t LatencyHistogram::count_upto(Nanoseconds time) const noexcept {
  if (time.count() < 0) return 0;
  const std::size_t last = bucket_of(static_cast<std::uint64_t>(time.count()));
  std::uint64_t count = 0;
  for (std::size_t bucket = 0; bucket <= last; ++bucket) count += counts_[bucket];
  return count;
}

}  // namespace ist
