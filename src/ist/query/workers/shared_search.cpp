#include "ist/query/workers/shared_search.h"

#include <algorithm>
#include <type_traits>

namespace ist {
namespace {

// Fewer pairs are not worth sharing. One step makes at most 64 pairs of each.
constexpr std::size_t kFewestPairs = 512, kMostPairs = 64 * kFewestPairs;
// The pairs of a chunk: 5 µs of work with all pairs below them, for closed jaws. A chunk takes far
// longer if surfaces lie on each other, or if one node overlaps many. The caller soon stops waiting
// for such a chunk.
constexpr std::size_t kChunkPairs = 24;
constexpr std::size_t kMostChunks = kMostPairs / kChunkPairs + 1;
constexpr std::size_t kShared = kMostPairs + kFrontierSpare;
constexpr std::size_t kFoundPairs = 1 << 18, kFoundLeaves = 1 << 15;

}  // namespace

SharedSearch::SharedSearch(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs,
                           std::chrono::nanoseconds period)
    : plan_(plan),
      kernels_(kernels),
      caller_(plan, kernels, pairs),
      helper_(plan, kernels, pairs),
      found_(kFoundPairs),
      adder_(std::make_unique<ContactAdder>()),
      found_leaves_(kFoundLeaves),
      work_(kMostChunks, period, this, [](void* self, std::size_t chunk, Part& part) noexcept {
        static_cast<SharedSearch*>(self)->help(chunk, part);
      }) {
  shared_.groups.resize(kShared);
  shared_.moving.resize(kShared);
}

template <class Lister>
SharedSearch::End SharedSearch::run(const SearchPose& pose, typename Lister::Sink& sink,
                                    const BudgetMeter& meter, Measured measured) noexcept {
  work_.begin();
  const Budget& budget = meter.budget();
  if (budget.has_tests()) {  // alone, so that no step is made twice
    Lister alone(pose, sink, meter, measured);
    const std::size_t steps = caller_.run(alone);
    return {steps, alone.tests(), sink.count(), alone.bounds()};
  }
  // Lists, but stops at the first level with enough pairs to share.
  struct Widening : Lister {
    using Lister::Lister;
    bool enter(std::size_t, const Frontier& pairs, bool whole) noexcept {
      wide = !whole || pairs.moving_count >= kFewestPairs;
      worth = whole && wide;
      if (whole)
        above = {0, this->tests(), 0, this->bounds()};  // a step that is not whole is made again
      return !wide;
    }
    bool wide = false, worth = false;
    End above{};
  } widening(pose, sink, meter, measured);
  const std::size_t step = caller_.run(widening);
  if (!widening.wide) return {step, widening.tests(), sink.count(), widening.bounds()};
  End above = widening.above;
  above.steps = step;
  if (widening.worth) work_.note_worth();
  const Frontier& pairs = caller_.frontier(step);
  if (!widening.worth || work_.is_busy()) {
    Lister alone(pose, sink, BudgetMeter(budget, above.tests), measured);
    const std::size_t steps = caller_.descend(step, pairs, 0, alone);
    above.bounds.add(alone.bounds());
    return {steps, alone.tests(), sink.count(), above.bounds};
  }
  share(pose, measured, step, pairs);
  End end{plan_.steps().size(), above.tests, 0, above.bounds};
  if (do_chunks<Lister>(budget, sink, end)) {
    end.leaf_pairs = sink.count();
    return end;
  }
  if (sink.stopped()) {
    above.leaf_pairs = sink.count();
  } else {
    sink.clear();
  }
  return above;
}

template SharedSearch::End SharedSearch::run<PairLister>(const SearchPose&, LeafPairSink&,
                                                         const BudgetMeter&, Measured) noexcept;
template SharedSearch::End SharedSearch::run<ContactVisitor>(const SearchPose&, ContactOutput&,
                                                             const BudgetMeter&, Measured) noexcept;

void SharedSearch::share(const SearchPose& pose, Measured measured, std::size_t step,
                         const Frontier& frontier) noexcept {
  shared_.pose = pose;
  shared_.measured = measured;
  shared_.step = step;
  std::copy_n(frontier.groups, frontier.group_count, shared_.groups.begin());
  std::copy_n(frontier.moving, frontier.moving_count, shared_.moving.begin());
  shared_.frontier = {shared_.groups.data(), shared_.moving.data(), frontier.group_count,
                      frontier.moving_count, kMostPairs};
}

template <class Lister>
bool SharedSearch::do_chunks(const Budget& budget, typename Lister::Sink& sink, End& end) noexcept {
  constexpr bool kContacts = std::is_same_v<Lister, ContactVisitor>;
  shared_.contacts = kContacts;
  if constexpr (kContacts) {
    adder_->rule = sink.adder().rule;
    adder_->stream = sink.leaves() != nullptr ? &found_leaves_ : nullptr;
  }
  work_.cut(shared_.frontier.group_count, kChunkPairs,
            [&](std::size_t group) -> std::size_t { return shared_.groups[group].end; });
  const auto search = [&](std::size_t chunk) {
    Lister lister(shared_.pose, sink, BudgetMeter(budget), shared_.measured);
    const bool whole = descend(chunk, caller_, lister);
    end.tests += lister.tests();
    end.bounds.add(lister.bounds());
    return whole;
  };
  const auto take = [&](const Part& part) {
    if constexpr (kContacts) {
      sink.append(part.totals, found_leaves_.part(part.begin, part.count));
    } else {
      sink.append({found_.data() + part.begin, part.count});
    }
    end.tests += part.tests;
    end.bounds.add(part.bounds);
    return !budget.is_past();
  };
  return !budget.is_past() && work_.run(budget, search, take);
}

template <class Lister>
bool SharedSearch::descend(std::size_t chunk, Search& search, Lister& lister) const noexcept {
  const auto [first, last] = work_.items(chunk);
  Frontier part = shared_.frontier;
  part.group_count = last;
  return search.descend(shared_.step, part, first, lister) == plan_.steps().size();
}

void SharedSearch::help(std::size_t chunk, Part& part) noexcept {
  const auto search = [&](auto lister) {
    descend(chunk, helper_, lister);
    part.tests = lister.tests();
    part.bounds = lister.bounds();
  };
  if (shared_.contacts) {
    adder_->clear();
    found_leaves_.shorten(part.begin);
    ContactOutput sink(plan_, kernels_, shared_.pose, *adder_, &found_leaves_);
    search(ContactVisitor(shared_.pose, sink, {}, shared_.measured));
    sink.flush();
    found_leaves_.close();
    part.totals = adder_->totals;
    part.count = found_leaves_.nodes().size() - part.begin;
    part.whole = !found_leaves_.is_short();
  } else {
    LeafPairSink sink(plan_, kernels_, std::span<LeafPair>(found_).subspan(part.begin));
    search(PairLister(shared_.pose, sink, {}, shared_.measured));
    part.count = sink.count();
    part.whole = !sink.truncated();
  }
}

std::size_t SharedSearch::bytes_for(const SearchPlan& plan, std::size_t pairs) noexcept {
  return 2 * Search::bytes_for(plan, pairs) + kFoundPairs * sizeof(LeafPair) +
         sizeof(ContactAdder) + kFoundLeaves * sizeof(LeafSum) +
         kShared * (sizeof(SearchGroup) + sizeof(std::uint32_t)) +
         SharedWork<Part>::bytes_for(kMostChunks);
}

}  // namespace ist
