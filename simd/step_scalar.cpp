#include "simd/dispatch.h"
#include "simd/lanes.h"
#include "simd/step.h"

namespace ist {
namespace {

// Decodes moving nodes [begin, end) of a frontier. Returns the number of lanes.
std::size_t decode_piece(const SearchSide& side, const Frontier& in, std::uint32_t begin,
                         std::uint32_t end, MovingLanes& lanes) {
  std::size_t count = 0;
  for (std::uint32_t i = begin; i < end; ++i) count += decode(side, in.moving[i], lanes, count);
  return count;
}

// Returns the tests that a group makes.
std::uint64_t group_tests(const SearchStep& step, const Frontier& in, const SearchGroup& group,
                          std::uint32_t begin) {
  std::uint64_t lanes = 0;
  for (std::uint32_t i = begin; i < group.end; ++i) lanes += opened(step.moving, in.moving[i]);
  return opened(step.fixed, group.fixed) * lanes;
}

}  // namespace

Advanced advance_scalar(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                        SearchCursor& cursor, Frontier& out, SearchScratch& scratch,
                        std::uint64_t most, Measured measured, DistanceBounds& bounds) {
  const bool slabs = step.fixed.slabs != nullptr;
  const Pads& pads = pads_of(pose, step);
  FixedRows& rows = scratch.rows[0];
  std::uint64_t tests = 0;
  for (; cursor.group < in.group_count; ++cursor.group, cursor.row = 0) {
    const SearchGroup& group = in.groups[cursor.group];
    const std::uint32_t begin = cursor.group == 0 ? 0 : in.groups[cursor.group - 1].end;
    if (tests > 0 && cursor.row == 0 && cursor.moving == 0 &&
        group_tests(step, in, group, begin) > most - tests) {
      break;
    }
    const std::uint32_t row_count = decode(step.fixed, group.fixed, scratch.fixed, 0);
    for (std::size_t row = 0; row < row_count; ++row) {
      turn(pose, pads, slabs, scratch.fixed, row, rows);
    }
    for (; cursor.row < row_count; ++cursor.row, cursor.moving = 0) {
      const std::uint32_t fixed = scratch.fixed.id[cursor.row];
      while (begin + cursor.moving < group.end) {
        const std::uint32_t first = begin + cursor.moving;
        if ((step.last || cursor.moving == 0) &&
            !has_room(out, 1, room_of_row(step, group.end - first))) {
          return {tests, true};
        }
        const std::uint32_t end = std::min(first + kPieceNodes, group.end);
        const std::size_t lanes = decode_piece(step.moving, in, first, end, scratch.moving);
        if (lanes > most - tests) return {tests, false};
        const std::size_t before = cursor.moving == 0 ? out.moving_count : begin_row(out, fixed);
        for (std::size_t at = 0; at < lanes; ++at) {
          const PairTest test(rows, cursor.row, scratch.moving, at, slabs);
          const bool overlapping = test.overlap();
          if (measured == Measured::kBoth || (measured == Measured::kUpper && overlapping)) {
            test.measure_upper(bounds);
          }
          if (measured == Measured::kBoth && (step.last || !overlapping)) {
            test.measure_lower(slabs, bounds);
          }
          if (overlapping) out.moving[out.moving_count++] = scratch.moving.id[at];
        }
        end_row(out, fixed, before);
        tests += lanes;
        cursor.moving = end - begin;
      }
    }
  }
  return {tests, false};
}

void write_leaf_pairs_scalar(const Frontier& leaves, LeafPair* out) {
  std::uint32_t i = 0;
  for (std::size_t g = 0; g < leaves.group_count; ++g) {
    for (; i < leaves.groups[g].end; ++i) out[i] = {leaves.groups[g].fixed, leaves.moving[i]};
  }
}

constinit const Kernels kScalarKernels{"scalar", advance_scalar, write_leaf_pairs_scalar,
                                       find_near_scalar};

}  // namespace ist
