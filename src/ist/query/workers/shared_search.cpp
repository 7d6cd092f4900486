#include "ist/query/workers/shared_search.h"

#include <algorithm>

#include "ist/query/workers/patience.h"

namespace ist {
namespace {

// Fewer pairs are not worth sharing; one step makes at most 64 pairs of each.
constexpr std::size_t kFewestPairs = 512, kMostPairs = 64 * kFewestPairs;
// The pairs of a chunk: with all below them 5 µs of work where jaws are closed. Where surfaces lie
// on each other, or one node overlaps many, it can take far longer; if it is the worker's last, it
// is dropped after some patience.
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
      period_(period),
      queue_(kMostChunks),
      parts_(queue_.capacity()),
      found_(kFoundPairs),
      adder_(std::make_unique<ContactAdder>()),
      found_leaves_(kFoundLeaves),
      job_([](void* self) noexcept { static_cast<SharedSearch*>(self)->help(); }, this) {
  shared_.groups.resize(kShared);
  shared_.moving.resize(kShared);
  shared_.chunk_ends.resize(queue_.capacity());
}

SharedSearch::~SharedSearch() {
  worker_.retract(job_);
  job_.wait_idle();
}

template <class Lister>
SharedSearch::End SharedSearch::run(const SearchPose& pose, typename Lister::Sink& sink,
                                    const BudgetMeter& meter, Measured measured) noexcept {
  worker_.tick(std::chrono::steady_clock::now(), period_);
  ++sharing_.queries;
  if (meter.budget().has_tests()) {  // alone, so that no step is made twice
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
  sharing_.worth += widening.worth ? 1U : 0U;
  const Frontier& pairs = caller_.frontier(step);
  if (!widening.worth || job_.busy()) {
    Lister alone(pose, sink, BudgetMeter(meter.budget(), above.tests), measured);
    const std::size_t steps = caller_.descend(step, pairs, 0, alone);
    above.bounds.add(alone.bounds());
    return {steps, alone.tests(), sink.count(), above.bounds};
  }
  want(sink);
  share(pose, measured, step, pairs);
  End end{plan_.steps().size(), above.tests, 0, above.bounds};
  if (!do_chunks<Lister>(meter.budget(), sink, end)) {
    if (sink.stopped()) {
      above.leaf_pairs = sink.count();
    } else {
      sink.clear();
    }
    return above;
  }
  end.leaf_pairs = sink.count();
  return end;
}

template SharedSearch::End SharedSearch::run<PairLister>(const SearchPose&, LeafPairSink&,
                                                         const BudgetMeter&, Measured) noexcept;
template SharedSearch::End SharedSearch::run<ContactVisitor>(const SearchPose&, ContactOutput&,
                                                             const BudgetMeter&, Measured) noexcept;

template <class Lister>
bool SharedSearch::do_chunks(const Budget& budget, typename Lister::Sink& sink, End& end) noexcept {
  // Searches a chunk. Returns whether all of it was done.
  const auto search = [&](std::size_t index) {
    std::size_t first = 0;
    const Frontier part = chunk(index, first);
    Lister lister(shared_.pose, sink, BudgetMeter(budget), shared_.measured);
    const std::size_t steps = caller_.descend(shared_.step, part, first, lister);
    end.tests += lister.tests();
    end.bounds.add(lister.bounds());
    return steps == plan_.steps().size();
  };
  // With back-to-back long queries the worker starts polling in the middle of one, so the job is
  // offered before each chunk.
  bool taken = worker_.offer(job_), in_time = !budget.is_past();
  std::size_t done = 0;
  while (in_time) {
    const auto index = queue_.claim_front();
    if (!index) break;
    in_time = search(*index);
    done += in_time ? 1U : 0U;
    if (!taken) taken = worker_.offer(job_);
  }
  for (std::size_t index = queue_.close(); index < chunk_count_ && in_time; ++index) {
    if (queue_.collect(index, patience(budget)) && parts_[index].whole) {
      const Part& part = parts_[index];
      collect(part, sink);
      end.tests += part.tests;
      end.bounds.add(part.bounds);
      ++sharing_.chunks;
      ++done;
      in_time = !budget.is_past();
    } else {
      ++sharing_.dropped;
      in_time = search(index);
      done += in_time ? 1U : 0U;
    }
  }
  if (taken && !worker_.retract(job_)) ++sharing_.shared;
  return done == chunk_count_;
}

void SharedSearch::want(const LeafPairSink& /*sink*/) noexcept { shared_.contacts = false; }

void SharedSearch::want(const ContactOutput& sink) noexcept {
  shared_.contacts = true;
  adder_->rule = sink.adder().rule;
  adder_->stream = sink.leaves() != nullptr ? &found_leaves_ : nullptr;
}

void SharedSearch::collect(const Part& part, LeafPairSink& sink) noexcept {
  sink.append({found_.data() + part.begin, part.count});
}

void SharedSearch::collect(const Part& part, ContactOutput& sink) noexcept {
  sink.append(part.totals, found_leaves_.part(part.begin, part.count));
}

void SharedSearch::share(const SearchPose& pose, Measured measured, std::size_t step,
                         const Frontier& frontier) noexcept {
  shared_.pose = pose;
  shared_.measured = measured;
  shared_.step = step;
  std::copy_n(frontier.groups, frontier.group_count, shared_.groups.begin());
  std::copy_n(frontier.moving, frontier.moving_count, shared_.moving.begin());
  shared_.frontier = {shared_.groups.data(), shared_.moving.data(), frontier.group_count,
                      frontier.moving_count, kMostPairs};
  chunk_count_ = 0;
  std::uint32_t begin = 0;
  for (std::size_t g = 0; g < frontier.group_count; ++g) {
    if (frontier.groups[g].end - begin < kChunkPairs && g + 1 < frontier.group_count) continue;
    shared_.chunk_ends[chunk_count_++] = g + 1;
    begin = frontier.groups[g].end;
  }
  shared_.epoch = queue_.open(chunk_count_);
}

Frontier SharedSearch::chunk(std::size_t index, std::size_t& first) const noexcept {
  first = index == 0 ? 0 : shared_.chunk_ends[index - 1];
  Frontier part = shared_.frontier;
  part.group_count = shared_.chunk_ends[index];
  return part;
}

void SharedSearch::help() noexcept {
  std::size_t used = 0;
  found_leaves_.clear();
  while (const auto index = queue_.claim_back(shared_.epoch)) {
    hand_over(HandOver::kClaimed);
    std::size_t first = 0;
    const Frontier part = chunk(*index, first);
    Part& made = parts_[*index];
    made.begin = used;
    if (shared_.contacts) {
      help_contacts(part, first, made);
    } else {
      help_pairs(part, first, made);
    }
    if (made.whole) used += made.count;
    hand_over(HandOver::kWorked);
    queue_.complete(shared_.epoch, *index);
  }
}

template <class Lister>
void SharedSearch::help_with(const Frontier& part, std::size_t first, typename Lister::Sink& sink,
                             Part& made) noexcept {
  Lister lister(shared_.pose, sink, {}, shared_.measured);
  helper_.descend(shared_.step, part, first, lister);
  made.tests = lister.tests();
  made.bounds = lister.bounds();
}

void SharedSearch::help_pairs(const Frontier& part, std::size_t first, Part& made) noexcept {
  LeafPairSink sink(plan_, kernels_, std::span<LeafPair>(found_).subspan(made.begin));
  help_with<PairLister>(part, first, sink, made);
  made.count = sink.count();
  made.whole = !sink.truncated();
}

void SharedSearch::help_contacts(const Frontier& part, std::size_t first, Part& made) noexcept {
  adder_->clear();
  found_leaves_.shorten(made.begin);
  ContactOutput sink(plan_, kernels_, shared_.pose, *adder_, &found_leaves_);
  help_with<ContactVisitor>(part, first, sink, made);
  sink.flush();
  found_leaves_.close();
  made.totals = adder_->totals;
  made.count = found_leaves_.nodes().size() - made.begin;
  made.whole = !found_leaves_.is_short();
}

std::size_t SharedSearch::bytes() const noexcept {
  return caller_.bytes() + helper_.bytes() + found_.size() * sizeof(LeafPair) +
         sizeof(ContactAdder) + found_leaves_.bytes() +
         shared_.groups.size() * sizeof(SearchGroup) +
         shared_.moving.size() * sizeof(std::uint32_t) + parts_.size() * sizeof(Part) +
         shared_.chunk_ends.size() * sizeof(std::size_t) +
         queue_.capacity() * sizeof(std::uint64_t);
}

std::size_t SharedSearch::bytes_for(const SearchPlan& plan, std::size_t pairs) noexcept {
  return 2 * Search::bytes_for(plan, pairs) + kFoundPairs * sizeof(LeafPair) +
         sizeof(ContactAdder) + kFoundLeaves * sizeof(LeafSum) +
         kShared * (sizeof(SearchGroup) + sizeof(std::uint32_t)) +
         kMostChunks * (sizeof(Part) + sizeof(std::size_t) + sizeof(std::uint64_t));
}

}  // namespace ist
