#include "ist/query/traversal/search.h"

#include <algorithm>
#include <limits>

namespace ist {
namespace {

// The most work between two looks at the clock.
constexpr std::size_t kPartGroups = 64, kPartLeafPairs = 512;

}  // namespace

Search::Search(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs)
    : plan_(plan), kernels_(kernels), scratch_(std::make_unique<SearchScratch>()) {
  const std::size_t steps = plan.steps().size();
  for (std::size_t i = 0; i <= steps; ++i) {
    const std::size_t most = i == 0 ? 1 : plan.most_pairs(i - 1);
    const std::size_t row = i == 0 ? 1 : plan.longest_row(i - 1);
    const std::size_t capacity = std::max(row, std::min({pairs, most, std::size_t{1} << 31}));
    Memory& memory = memory_.emplace_back();
    memory.groups.resize(capacity + kFrontierSpare);
    memory.moving.resize(capacity + kFrontierSpare);
    frontiers_.push_back({memory.groups.data(), memory.moving.data(), 0, 0, capacity});
  }
  // Makes the first dispatched call. With infinite pads all bounds overlap, wherever the bodies
  // lie.
  SearchPose pose{};
  pose.ball_pad = pose.slab_pad = std::numeric_limits<float>::infinity();
  std::uint64_t tests = 0;
  static_cast<void>(widen(pose, 64, tests));
}

std::uint64_t Search::run(const SearchPose& pose, LeafPairSink& sink) noexcept {
  set_roots();
  return descend(0, frontiers_[0], 0, pose, sink);
}

std::uint64_t Search::run_hurried(const SearchPose& pose, LeafPairSink& sink,
                                  std::size_t groups) noexcept {
  groups_at_once_ = groups;
  const std::uint64_t tests = run(pose, sink);
  groups_at_once_ = kAllGroups;
  return tests;
}

Search::Stopped Search::run_until(const Budget& budget, const SearchPose& pose,
                                  LeafPairSink& sink) noexcept {
  set_roots();
  return descend_until(budget, 0, 0, frontiers_[0], 0, pose, sink);
}

Search::Stopped Search::descend_until(const Budget& budget, std::uint64_t tests, std::size_t step,
                                      const Frontier& in, std::size_t first, const SearchPose& pose,
                                      LeafPairSink& sink) noexcept {
  stopping_ = {budget, tests};
  std::size_t& room = frontiers_.back().capacity;
  const std::size_t all_room = room;
  if (budget.has_tests() || budget.has_deadline()) {
    groups_at_once_ = kPartGroups;
    room = std::min(kPartLeafPairs, room);
  }
  tests += descend(step, in, first, pose, sink);
  room = all_room;
  groups_at_once_ = kAllGroups;
  const std::size_t steps = std::min(stopping_.steps, plan_.steps().size());
  stopping_ = {};
  return {tests, steps, sink.count()};
}

void Search::set_roots() noexcept {
  Frontier& roots = frontiers_.front();
  roots.groups[0] = {0, 1};
  roots.moving[0] = 0;
  roots.group_count = roots.moving_count = 1;
}

std::size_t Search::widen(const SearchPose& pose, std::size_t pairs,
                          std::uint64_t& tests) noexcept {
  set_roots();
  std::size_t step = 0;
  for (; step < plan_.steps().size(); ++step) {
    const Frontier& in = frontiers_[step];
    Frontier& out = frontiers_[step + 1];
    if (in.moving_count == 0 || in.moving_count >= pairs) break;
    out.group_count = out.moving_count = 0;
    SearchCursor cursor;
    const std::uint64_t made =
        kernels_.advance(plan_.steps()[step], pose, in, cursor, out, *scratch_);
    if (cursor.group < in.group_count)
      break;  // `out` is full: descend() must do this step in parts
    tests += made;
  }
  return step;
}

std::uint64_t Search::descend(std::size_t step, const Frontier& in, std::size_t first,
                              const SearchPose& pose, LeafPairSink& sink) noexcept {
  if (step == plan_.steps().size()) {
    sink.append(in, kernels_, plan_);
    return 0;
  }
  Frontier& out = frontiers_[step + 1];
  SearchCursor cursor{first, 0};
  std::uint64_t tests = 0;
  while (cursor.group < in.group_count && !sink.stopped() && !stopping_.now(step)) {
    out.group_count = out.moving_count = 0;
    Frontier some = in;
    some.group_count = cursor.group + std::min(groups_at_once_, in.group_count - cursor.group);
    const std::uint64_t made =
        kernels_.advance(plan_.steps()[step], pose, some, cursor, out, *scratch_);
    tests += made;
    stopping_.tests += made;
    if (out.group_count > 0) tests += descend(step + 1, out, 0, pose, sink);
  }
  return tests;
}

std::size_t Search::bytes() const noexcept {
  std::size_t bytes = sizeof(SearchScratch);
  for (const Memory& memory : memory_) {
    bytes +=
        memory.groups.size() * sizeof(SearchGroup) + memory.moving.size() * sizeof(std::uint32_t);
  }
  return bytes;
}

}  // namespace ist
