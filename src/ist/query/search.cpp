#include "ist/query/search.h"

#include <algorithm>
#include <limits>

namespace ist {

void ContactSink::append(const Frontier& leaves, const Kernels& kernels,
                         const SearchPlan& plan) noexcept {
  const std::size_t begin = std::min<std::size_t>(count_, out_.size());
  const std::size_t room = out_.size() - begin;
  // Whole groups by vectors, which write past their end; what is left one by one.
  Frontier fast = leaves;
  while (fast.group_count > 0 && fast.groups[fast.group_count - 1].end + kContactSlack > room) {
    --fast.group_count;
  }
  Contact* out = out_.data() + begin;
  kernels.write_contacts(fast, out);
  std::uint32_t i = fast.group_count > 0 ? fast.groups[fast.group_count - 1].end : 0;
  for (std::size_t g = fast.group_count; g < leaves.group_count; ++g) {
    const SearchGroup group = leaves.groups[g];
    for (; i < group.end && i < room; ++i) out[i] = {group.fixed, leaves.moving[i]};
  }
  plan.resolve({out, std::min(room, leaves.moving_count)});
  count_ += leaves.moving_count;
}

void ContactSink::append(std::span<const Contact> contacts) noexcept {
  const std::size_t begin = std::min<std::size_t>(count_, out_.size());
  const std::size_t fit = std::min(contacts.size(), out_.size() - begin);
  std::copy_n(contacts.begin(), fit, out_.begin() + static_cast<std::ptrdiff_t>(begin));
  count_ += contacts.size();
}

Search::Search(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs)
    : plan_(plan), kernels_(kernels), scratch_(std::make_unique<SearchScratch>()) {
  const std::size_t steps = plan.steps().size();
  for (std::size_t i = 0; i <= steps; ++i) {
    const std::size_t most = i == 0 ? 1 : plan.most_pairs(i - 1);
    const std::size_t row = i == 0 ? 1 : plan.longest_row(i - 1);
    const std::size_t capacity = std::max(row, std::min({pairs, most, std::size_t{1} << 31}));
    Memory& memory = memory_.emplace_back();
    memory.groups.resize(capacity + kFrontierSlack);
    memory.moving.resize(capacity + kFrontierSlack);
    frontiers_.push_back({memory.groups.data(), memory.moving.data(), 0, 0, capacity});
  }
  // The first dispatch: with pads without end all touches, wherever the bodies lie.
  SearchPose pose{};
  pose.ball_pad = pose.slab_pad = std::numeric_limits<float>::infinity();
  std::uint64_t tests = 0;
  static_cast<void>(widen(pose, 64, tests));
}

std::uint64_t Search::run(const SearchPose& pose, ContactSink& sink) noexcept {
  set_roots();
  return descend(0, frontiers_[0], 0, pose, sink);
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
    if (cursor.group < in.group_count) break;  // `out` is full: this step is to be made in parts
    tests += made;
  }
  return step;
}

std::uint64_t Search::descend(std::size_t step, const Frontier& in, std::size_t first,
                              const SearchPose& pose, ContactSink& sink) noexcept {
  if (step == plan_.steps().size()) {
    sink.append(in, kernels_, plan_);
    return 0;
  }
  Frontier& out = frontiers_[step + 1];
  SearchCursor cursor{first, 0};
  std::uint64_t tests = 0;
  while (cursor.group < in.group_count) {
    out.group_count = out.moving_count = 0;
    tests += kernels_.advance(plan_.steps()[step], pose, in, cursor, out, *scratch_);
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
