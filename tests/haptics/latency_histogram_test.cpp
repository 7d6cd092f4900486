#include "ist/haptics/latency_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "support/random.h"

namespace ist::test {
namespace {

using Nanoseconds = std::chrono::nanoseconds;
constexpr std::int64_t kEnd = std::int64_t{1} << 36;

LatencyHistogram recorded(const std::vector<std::int64_t>& times) {
  LatencyHistogram histogram;
  for (const std::int64_t time : times) histogram.record(Nanoseconds(time));
  return histogram;
}

// The shortest time that at least q of all are no longer than.
std::int64_t true_quantile(const std::vector<std::int64_t>& sorted, double q) {
  const double rank = std::ceil(q * static_cast<double>(sorted.size()));
  return sorted[rank < 1 ? 0 : static_cast<std::size_t>(rank) - 1];
}

void expect_all_quantiles(std::vector<std::int64_t> times) {
  const LatencyHistogram histogram = recorded(times);
  std::sort(times.begin(), times.end());
  EXPECT_EQ(histogram.count(), times.size());
  EXPECT_EQ(histogram.max().count(), times.back());
  const std::int64_t sum = std::accumulate(times.begin(), times.end(), std::int64_t{0});
  EXPECT_EQ(histogram.mean().count(), sum / static_cast<std::int64_t>(times.size()));
  std::vector<double> quantiles = {0, 0.5, 0.9, 0.99, 0.999, 0.9999, 0.99999, 1};
  for (int i = 1; i < 1000; ++i) quantiles.push_back(i / 1000.0);
  for (const double q : quantiles) {
    const std::int64_t is = true_quantile(times, q), said = histogram.quantile(q).count();
    ASSERT_GE(said, is) << q;
    ASSERT_LE(said - is, is / 32) << q << ": " << is;
    ASSERT_LE(said, times.back()) << q;
  }
  EXPECT_EQ(histogram.quantile(1), histogram.max());
}

TEST(LatencyHistogram, QuantilesAreNeverTooSmallAndHardlyTooLarge) {
  Random random(1);
  const std::vector<std::function<double()>> distributions = {
      [&] { return random.uniform(0, 1000); },
      [&] { return random.uniform(0, 1e9); },
      [&] { return std::exp2(random.uniform(0, 36)) - 0.5; },
      [&] { return -1e5 * std::log(1 - random.uniform(0, 1)); },
      [&] { return std::min(6.8e10, 1e3 / std::pow(1 - random.uniform(0, 1), 2)); },
      [&] { return random.below(1000) == 0 ? 5e6 : random.uniform(50e3, 60e3); },
      [&] { return std::exp2(std::floor(random.uniform(0, 36))); },
      [&] { return std::exp2(std::ceil(random.uniform(0, 36))) - 1; },
      [&] { return 123456789.0; },
      [&] { return random.uniform(0, 8); },
  };
  for (std::size_t i = 0; i < distributions.size(); ++i) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{7}, std::size_t{20000}}) {
      SCOPED_TRACE(testing::Message() << "distribution " << i << ", " << count << " times");
      std::vector<std::int64_t> times(count);
      for (std::int64_t& time : times) time = static_cast<std::int64_t>(distributions[i]());
      expect_all_quantiles(times);
    }
  }
}

TEST(LatencyHistogram, IsExactForShortTimes) {
  LatencyHistogram histogram;
  for (std::int64_t time = 0; time < 64; ++time) histogram.record(Nanoseconds(time));
  for (int time = 0; time < 64; ++time) {
    EXPECT_EQ(histogram.quantile((time + 1) / 64.0).count(), time);
  }
}

TEST(LatencyHistogram, BucketsMeetAtEachOctaveAndEachOfItsParts) {
  // A time is told from another exactly where a bucket ends between them, so the buckets' ends can
  // be read off quantiles: those of the definition, and no others.
  for (int octave = 6; octave < 36; ++octave) {
    const std::int64_t begin = std::int64_t{1} << octave, width = begin / 32;
    for (int part = 0; part < 32; ++part) {
      const std::int64_t first = begin + part * width, last = first + width - 1;
      const std::int64_t above = std::min(last + 1, kEnd - 1);
      const LatencyHistogram histogram = recorded({first - 1, first, last, above, kEnd});
      EXPECT_EQ(histogram.quantile(0.2).count(), first - 1);
      EXPECT_EQ(histogram.quantile(0.4), histogram.quantile(0.6));
      if (last < kEnd - 1) {
        EXPECT_EQ(histogram.quantile(0.6).count(), last);
        EXPECT_GT(histogram.quantile(0.8).count(), last);
      }
    }
  }
}

TEST(LatencyHistogram, CountsUpToATimeWithItsBucket) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.count_upto(Nanoseconds(100)), 0u);
  for (const int time : {0, 3, 63, 64, 65, 66, 1000}) histogram.record(Nanoseconds(time));
  EXPECT_EQ(histogram.count_upto(Nanoseconds(-1)), 0u);
  EXPECT_EQ(histogram.count_upto(Nanoseconds(0)), 1u);
  EXPECT_EQ(histogram.count_upto(Nanoseconds(2)), 1u);
  EXPECT_EQ(histogram.count_upto(Nanoseconds(63)), 3u);
  EXPECT_EQ(histogram.count_upto(Nanoseconds(64)), 5u);  // 64 and 65 share one
  EXPECT_EQ(histogram.count_upto(Nanoseconds(991)), 6u);
  EXPECT_EQ(histogram.count_upto(Nanoseconds(992)), 7u);  // to 1007 is another
  EXPECT_EQ(histogram.count_upto(std::chrono::hours(1)), 7u);
}

TEST(LatencyHistogram, CountsANegativeTimeAsZero) {
  const LatencyHistogram histogram = recorded({-1, std::numeric_limits<std::int64_t>::min()});
  EXPECT_EQ(histogram.count(), 2u);
  EXPECT_EQ(histogram.max().count(), 0);
  EXPECT_EQ(histogram.mean().count(), 0);
  EXPECT_EQ(histogram.quantile(1).count(), 0);
}

TEST(LatencyHistogram, KeepsTheLongestOfTimesBeyondItsBuckets) {
  constexpr std::int64_t kLongest = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t time : {kEnd - 1, kEnd, 3 * kEnd, kLongest}) {
    const LatencyHistogram histogram = recorded({5, time, 7});
    EXPECT_EQ(histogram.max().count(), time);
    EXPECT_EQ(histogram.quantile(1).count(), time);
    EXPECT_EQ(histogram.quantile(0.5).count(), 7);
  }
  // All of them together are cut at 584 years, and their mean is then too small.
  const LatencyHistogram five = recorded({kLongest, kLongest, kLongest, kLongest, kLongest});
  EXPECT_EQ(five.count(), 5u);
  EXPECT_EQ(static_cast<std::uint64_t>(five.mean().count()),
            std::numeric_limits<std::uint64_t>::max() / 5);
}

TEST(LatencyHistogram, HoldsNothingAtFirstAndWhenCleared) {
  LatencyHistogram histogram;
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(histogram.count(), 0u);
    EXPECT_EQ(histogram.max().count(), 0);
    EXPECT_EQ(histogram.mean().count(), 0);
    for (const double q : {0.0, 0.5, 1.0}) EXPECT_EQ(histogram.quantile(q).count(), 0);
    histogram.record(Nanoseconds(kEnd * 2));
    histogram.record(Nanoseconds(1000));
    histogram.clear();
  }
}

TEST(LatencyHistogram, MergingEqualsRecordingAll) {
  Random random(2);
  std::vector<std::int64_t> all, parts[2];
  for (int i = 0; i < 5000; ++i) {
    const auto time = static_cast<std::int64_t>(std::exp2(random.uniform(0, 38)));
    all.push_back(time);
    parts[random.below(3) == 0 ? 0 : 1].push_back(time);
  }
  LatencyHistogram merged = recorded(parts[0]);
  merged.merge(recorded(parts[1]));
  merged.merge(LatencyHistogram());
  const LatencyHistogram whole = recorded(all);
  EXPECT_EQ(merged.count(), whole.count());
  EXPECT_EQ(merged.max(), whole.max());
  EXPECT_EQ(merged.mean(), whole.mean());
  for (int i = 0; i <= 1000; ++i) {
    ASSERT_EQ(merged.quantile(i / 1000.0), whole.quantile(i / 1000.0)) << i;
  }
}

}  // namespace
}  // namespace ist::test
