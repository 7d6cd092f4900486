#pragma once

#include <cstdint>
#include <span>

#include "ist/query/results.h"
#include "ist/query/traversal/search_plan.h"
#include "simd/dispatch.h"

namespace ist {

/// The destination of leaf pairs. All are counted; the first go into a span, or all go to a stream.
class LeafPairSink {
 public:
  LeafPairSink(const SearchPlan& plan, const Kernels& kernels, std::span<LeafPair> out) noexcept
      : plan_(plan), kernels_(kernels), out_(out) {}
  /// Passes leaf pairs to the stream through `window`, which has room for more than kLeafPairSpare
  /// of them.
  LeafPairSink(const SearchPlan& plan, const Kernels& kernels, std::span<LeafPair> window,
               LeafPairStream& stream) noexcept
      : plan_(plan), kernels_(kernels), out_(window), stream_(&stream) {}

  /// Appends the pairs of a frontier of leaves.
  void append(const Frontier& leaves) noexcept;
  /// Appends leaf pairs that another sink took.
  void append(std::span<const LeafPair> leaf_pairs) noexcept;

  /// Forgets all pairs that were appended to the span.
  void clear() noexcept { count_ = 0; }

  /// Returns the number of leaf pairs appended, in the span or not; with a stream, of those that it
  /// was given.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// Returns whether the span was too short.
  [[nodiscard]] bool truncated() const noexcept {
    return stream_ == nullptr && count_ > out_.size();
  }
  /// Returns whether the stream refused more pairs.
  [[nodiscard]] bool stopped() const noexcept { return stopped_; }

 private:
  void hand_over(std::span<const LeafPair> leaf_pairs) noexcept {
    if (stopped_ || leaf_pairs.empty()) return;
    count_ += leaf_pairs.size();
    stopped_ = !stream_->take(leaf_pairs);
  }

  const SearchPlan& plan_;
  const Kernels& kernels_;
  std::span<LeafPair> out_;
  LeafPairStream* stream_ = nullptr;
  std::uint64_t count_ = 0;
  bool stopped_ = false;
};

}  // namespace ist
