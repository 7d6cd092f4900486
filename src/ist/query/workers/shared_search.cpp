#include "ist/query/workers/shared_search.h"

#include <algorithm>

namespace ist {
namespace {

// Fewer pairs are not worth sharing; one step makes at most 64 pairs of each.
constexpr std::size_t kFewestPairs = 512, kMostPairs = 64 * kFewestPairs;
// The pairs of a chunk: with all below them 5 µs of work where jaws are closed. Where surfaces lie
// on each other, or one node overlaps many, it can take far longer; if it is the worker's last, it
// is dropped after kPatience.
constexpr std::size_t kChunkPairs = 24;
// The time that the caller, when done, waits for the worker's last chunk.
constexpr std::chrono::microseconds kPatience{20};
constexpr std::size_t kFoundContacts = 1 << 18;

}  // namespace

SharedSearch::SharedSearch(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs,
                           std::chrono::nanoseconds period)
    : plan_(plan),
      caller_(plan, kernels, pairs),
      helper_(plan, kernels, pairs),
      period_(period),
      queue_(kMostPairs / kChunkPairs + 1),
      parts_(queue_.capacity()),
      found_(kFoundContacts),
      job_([](void* self) noexcept { static_cast<SharedSearch*>(self)->help(); }, this) {
  shared_.groups.resize(kMostPairs + kFrontierSpare);
  shared_.moving.resize(kMostPairs + kFrontierSpare);
  shared_.chunk_ends.resize(queue_.capacity());
}

SharedSearch::~SharedSearch() {
  worker_.retract(job_);
  job_.wait_idle();
}

Search::Stopped SharedSearch::run_until(const Budget& budget, const SearchPose& pose,
                                        LeafPairSink& sink) noexcept {
  worker_.tick(std::chrono::steady_clock::now(), period_);
  ++sharing_.queries;
  std::uint64_t tests = 0;
  const std::size_t step = caller_.widen(pose, kFewestPairs, tests);
  const Frontier& pairs = caller_.frontier(step);
  const bool worth = step < plan_.steps().size() && pairs.moving_count >= kFewestPairs;
  sharing_.worth += worth ? 1U : 0U;
  if (!worth || budget.has_tests() || job_.busy()) {
    return caller_.descend_until(budget, tests, step, pairs, 0, pose, sink);
  }
  share(pose, step, pairs);
  const Search::Stopped stopped{tests, step, 0};
  if (!do_chunks(budget, sink, tests)) return stopped;
  return {tests, plan_.steps().size(), sink.count()};
}

bool SharedSearch::do_chunks(const Budget& budget, LeafPairSink& sink,
                             std::uint64_t& tests) noexcept {
  // Searches a chunk. Returns whether there was time for all of it.
  const auto search = [&](std::size_t index) {
    std::size_t first = 0;
    const Frontier part = chunk(index, first);
    const Search::Stopped made =
        caller_.descend_until(budget, 0, shared_.step, part, first, shared_.pose, sink);
    tests += made.tests;
    return made.steps == plan_.steps().size();
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
    if (queue_.collect(index, kPatience) && parts_[index].whole) {
      sink.append({found_.data() + parts_[index].begin, parts_[index].count});
      tests += parts_[index].tests;
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

void SharedSearch::share(const SearchPose& pose, std::size_t step,
                         const Frontier& frontier) noexcept {
  shared_.pose = pose;
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
  while (const auto index = queue_.claim_back(shared_.epoch)) {
    hand_over(HandOver::kClaimed);
    LeafPairSink sink(std::span<LeafPair>(found_).subspan(used));
    std::size_t first = 0;
    const Frontier part = chunk(*index, first);
    Part& made = parts_[*index];
    made.begin = used;
    made.tests = helper_.descend(shared_.step, part, first, shared_.pose, sink);
    made.count = sink.count();
    made.whole = !sink.truncated();
    if (made.whole) used += made.count;
    hand_over(HandOver::kWorked);
    queue_.complete(shared_.epoch, *index);
  }
}

std::size_t SharedSearch::bytes() const noexcept {
  return caller_.bytes() + helper_.bytes() + found_.size() * sizeof(LeafPair) +
         shared_.groups.size() * sizeof(SearchGroup) +
         shared_.moving.size() * sizeof(std::uint32_t) + parts_.size() * sizeof(Part) +
         shared_.chunk_ends.size() * sizeof(std::size_t) +
         queue_.capacity() * sizeof(std::uint64_t);
}

}  // namespace ist
