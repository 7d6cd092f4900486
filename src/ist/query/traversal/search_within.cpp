#include <algorithm>
#include <utility>

#include "ist/query/traversal/search.h"

namespace ist {
namespace {

// Moving nodes decoded at a time: no more lanes than tests allowed between two looks at the clock.
constexpr std::uint32_t kPiece = 56;
constexpr std::size_t kPieceLanes = 8 * kPiece;
static_assert(kPieceLanes <= Spending::kUnwatched);

}  // namespace

Search::AnytimeResult Search::run_within(const Budget& budget, const SearchPose& pose,
                                         LeafPairSink& sink) noexcept {
  Spending spending(budget);
  AnytimeResult known;
  known.steps = plan_.steps().size();
  set_roots();
  std::size_t& room = frontiers_.back().capacity;
  const std::size_t all_room = std::exchange(room, std::min(kLeavesAtOnce, room));
  static_cast<void>(descend_within(0, pose, sink, spending, known));
  room = all_room;
  known.tests = spending.tests();
  return known;
}

// Returns false where the budget ends the search early, and then records the first step that is not
// whole.
bool Search::descend_within(std::size_t step, const SearchPose& pose, LeafPairSink& sink,
                            Spending& spending, AnytimeResult& known) noexcept {
  const Frontier& in = frontiers_[step];
  if (step == plan_.steps().size()) {
    sink.append(in, kernels_, plan_);
    return true;
  }
  Frontier& out = frontiers_[step + 1];
  DistanceBounds& measure = step + 1 == plan_.steps().size() ? known.leaves : known.inner;
  SearchCursor cursor;
  while (cursor.group < in.group_count && !sink.stopped()) {
    out.group_count = out.moving_count = 0;
    const bool enough = advance_within(step, pose, cursor, spending, measure);
    if (enough && (out.group_count == 0 || descend_within(step + 1, pose, sink, spending, known))) {
      continue;
    }
    if (!enough || cursor.group < in.group_count) known.steps = step;
    if (!enough && step + 1 == plan_.steps().size()) sink.append(out, kernels_, plan_);
    return false;
  }
  return true;
}

// Advances until `in` is done or `out` is full. Returns false where the budget is spent.
bool Search::advance_within(std::size_t step, const SearchPose& pose, SearchCursor& cursor,
                            Spending& spending, DistanceBounds& measure) noexcept {
  const SearchStep& by = plan_.steps()[step];
  const StepParts& parts = kernels_.parts;
  const bool slabs = by.fixed.slabs != nullptr;
  const Frontier& in = frontiers_[step];
  Frontier& out = frontiers_[step + 1];
  FixedRows& rows = scratch_->rows[0];
  MovingLanes& lanes = scratch_->moving;
  // The last frontier takes a row in parts: a long one would take too long to hand over.
  const bool in_parts = step + 1 == plan_.steps().size();
  for (; cursor.group < in.group_count; ++cursor.group, cursor.row = 0) {
    const SearchGroup group = in.groups[cursor.group];
    const std::uint32_t begin = cursor.group == 0 ? 0 : in.groups[cursor.group - 1].end;
    const std::size_t most = std::size_t{group.end - begin} * (by.moving.descends ? 8 : 1);
    const std::uint32_t row_count = decode(by.fixed, group.fixed, scratch_->fixed, 0);
    parts.turn(pose, slabs, scratch_->fixed, rows);
    std::size_t end = 0;  // of the decoded lanes
    for (; cursor.row < row_count; ++cursor.row, cursor.moving = 0) {
      if (!has_room(out, 1, in_parts ? std::min(most, kPieceLanes) : most)) return true;
      const std::size_t before = out.moving_count;
      for (std::uint32_t i = begin + cursor.moving; i < group.end; i += kPiece) {
        if (in_parts && !has_room(out, 1, kPieceLanes)) {
          end_row(out, scratch_->fixed.id[cursor.row], before);
          cursor.moving = i - begin;
          return true;
        }
        const std::uint32_t piece_end = std::min(i + kPiece, group.end);
        if (end == 0 || group.end - begin > kPiece) {  // else decoded for the row before
          end = 0;
          for (std::uint32_t k = i; k < piece_end; ++k) {
            end += parts.decode(by.moving, in.moving[k], lanes, end);
          }
        }
        if (!spending.spend(end)) {
          end_row(out, scratch_->fixed.id[cursor.row], before);
          return false;
        }
        out.moving_count += parts.measure_row(rows, cursor.row, lanes, 0, end, slabs,
                                              out.moving + out.moving_count, measure);
      }
      end_row(out, scratch_->fixed.id[cursor.row], before);
    }
  }
  return true;
}

}  // namespace ist
