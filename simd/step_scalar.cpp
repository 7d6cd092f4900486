#include "simd/dispatch.h"
#include "simd/lanes.h"
#include "simd/step.h"

namespace ist {
namespace {

void turn_rows(const SearchPose& pose, bool slabs, const FixedLanes& fixed, FixedRows& rows) {
  for (std::size_t at = 0; at < FixedLanes::kSize; ++at) turn(pose, slabs, fixed, at, rows);
}

std::size_t overlap_row(const FixedRows& rows, std::size_t row, const MovingLanes& moving,
                        std::size_t begin, std::size_t end, bool slabs, std::uint32_t* out) {
  std::size_t count = 0;
  for (std::size_t at = begin; at < end; ++at) {
    if (overlap(rows, row, moving, at, slabs)) out[count++] = moving.id[at];
  }
  return count;
}

std::size_t measure_row(const FixedRows& rows, std::size_t row, const MovingLanes& moving,
                        std::size_t begin, std::size_t end, bool slabs, std::uint32_t* out,
                        DistanceBounds& measured) {
  std::size_t count = 0;
  for (std::size_t at = begin; at < end; ++at) {
    if (measure(rows, row, moving, at, slabs, measured)) out[count++] = moving.id[at];
  }
  return count;
}

}  // namespace

std::uint64_t advance_scalar(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                             SearchCursor& cursor, Frontier& out, SearchScratch& scratch) {
  const bool slabs = step.fixed.slabs != nullptr;
  FixedRows& rows = scratch.rows[0];
  std::uint64_t tests = 0;
  for (; cursor.group < in.group_count; ++cursor.group, cursor.row = 0) {
    const SearchGroup& group = in.groups[cursor.group];
    const std::uint32_t begin = cursor.group == 0 ? 0 : in.groups[cursor.group - 1].end;
    const std::size_t most = std::size_t{group.end - begin} * (step.moving.descends ? 8 : 1);
    const std::uint32_t row_count = decode(step.fixed, group.fixed, scratch.fixed, 0);
    for (std::size_t row = 0; row < row_count; ++row) turn(pose, slabs, scratch.fixed, row, rows);
    for (; cursor.row < row_count; ++cursor.row) {
      if (!has_room(out, 1, most)) return tests;
      const std::size_t before = out.moving_count;
      for (std::uint32_t i = begin; i < group.end; ++i) {
        const std::uint32_t count = decode(step.moving, in.moving[i], scratch.moving, 0);
        tests += count;
        for (std::size_t at = 0; at < count; ++at) {
          if (!overlap(rows, cursor.row, scratch.moving, at, slabs)) continue;
          out.moving[out.moving_count++] = scratch.moving.id[at];
        }
      }
      end_row(out, scratch.fixed.id[cursor.row], before);
    }
  }
  return tests;
}

void write_leaf_pairs_scalar(const Frontier& leaves, LeafPair* out) {
  std::uint32_t i = 0;
  for (std::size_t g = 0; g < leaves.group_count; ++g) {
    for (; i < leaves.groups[g].end; ++i) out[i] = {leaves.groups[g].fixed, leaves.moving[i]};
  }
}

constinit const Kernels kScalarKernels{
    "scalar",
    advance_scalar,
    write_leaf_pairs_scalar,
    {decode<MovingLanes::kSize>, turn_rows, overlap_row, measure_row},
    find_near_scalar};

}  // namespace ist
