#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "ist/query/results.h"
#include "ist/query/traversal/budget_meter.h"
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

/// One call of a step, complete but for the numbers that a visitor chooses.
struct SearchBatch {
  static constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

  const Kernels& kernels;
  const SearchStep& step;
  const Frontier& in;
  SearchCursor& cursor;
  Frontier& out;
  SearchScratch& scratch;

  /// Makes at most `most` tests.
  Advanced advance(const SearchPose& pose, std::uint64_t most = kNoLimit) const noexcept {
    DistanceBounds none;
    return measure(Measured::kNothing, pose, none, most);
  }
  Advanced measure(Measured measured, const SearchPose& pose, DistanceBounds& bounds,
                   std::uint64_t most = kNoLimit) const noexcept {
    return kernels.advance(step, pose, in, cursor, out, scratch, most, measured, bounds);
  }
};

/// The purpose of a search: it makes the steps and takes the leaf pairs. VisitorBase has the
/// defaults of the last three.
template <class V>
concept SearchVisitor = requires(V visitor, const SearchBatch& batch, const Frontier& pairs,
                                 std::size_t step) {
  /// Makes one call of a step. The search ends where it makes no test though some are left.
  { visitor.advance(batch) } -> std::same_as<Advanced>;
  /// Takes the pairs of a frontier of leaves. Returns whether more are wanted.
  { visitor.leaves(pairs) } -> std::same_as<bool>;
  /// Decides whether to search on from the pairs before `step`; `whole` says that these are all
  /// of them. The search ends where it returns false.
  { visitor.enter(step, pairs, true) } -> std::same_as<bool>;
  /// Returns the most fixed nodes of a level to search from at a time: with few, the first leaf
  /// pairs come sooner, all of them later.
  { visitor.most_groups() } -> std::same_as<std::size_t>;
  /// Returns the most leaf pairs to take at a time, at least kPieceTests.
  { visitor.most_leaves() } -> std::same_as<std::size_t>;
};

struct VisitorBase {
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  static bool enter(std::size_t /*step*/, const Frontier& /*pairs*/, bool /*whole*/) noexcept {
    return true;
  }
  static std::size_t most_groups() noexcept { return kAll; }
  static std::size_t most_leaves() noexcept { return kAll; }
};

/// A visitor that spends a budget and measures distances.
class MeteredVisitor : public VisitorBase {
 public:
  MeteredVisitor(const SearchPose& pose, const BudgetMeter& meter, Measured measured) noexcept
      : pose_(pose), meter_(meter), measured_(measured) {}

  /// Returns the tests made, with those that the meter began with.
  [[nodiscard]] std::uint64_t tests() const noexcept { return meter_.spent(); }
  [[nodiscard]] const DistanceBounds& bounds() const noexcept { return bounds_; }

 protected:
  const SearchPose& pose_;
  BudgetMeter meter_;
  Measured measured_;
  DistanceBounds bounds_;
};

/// Passes all leaf pairs to a sink, within a budget. A budget that ends the search early leaves the
/// first leaf pairs in the sink.
class PairLister : public MeteredVisitor {
 public:
  using Sink = LeafPairSink;

  PairLister(const SearchPose& pose, LeafPairSink& sink, const BudgetMeter& meter = {},
             Measured measured = Measured::kNothing) noexcept
      : MeteredVisitor(pose, meter, measured), sink_(sink) {}

  Advanced advance(const SearchBatch& batch) noexcept {
    const Advanced made = batch.measure(measured_, pose_, bounds_, meter_.allow());
    meter_.spend(made.tests);
    return made;
  }
  bool leaves(const Frontier& pairs) noexcept {
    sink_.append(pairs);
    return !sink_.stopped();
  }
  [[nodiscard]] std::size_t most_leaves() const noexcept { return meter_.most_pairs(); }

 private:
  LeafPairSink& sink_;
};

}  // namespace ist
