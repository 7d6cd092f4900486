#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/step_vector.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/bounds-inl.h"
#include "simd/lanes.h"
#include "simd/near-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Prefetch distance, in nodes: time enough for memory to answer, not enough for the lines to be
// evicted again.
constexpr std::size_t kAhead = 24;

// The place of each group of a batch in the scratch memory.
struct Batch {
  std::size_t groups = 0;
  std::size_t begin[SearchScratch::kGroups], end[SearchScratch::kGroups];
  std::uint32_t rows[SearchScratch::kGroups], id[SearchScratch::kGroups];
};

template <bool kSlabs>
HWY_INLINE void Prefetch(const SearchSide& side, std::uint32_t parent) {
  __builtin_prefetch(side.nodes + parent);
  __builtin_prefetch(side.balls + parent);
  if constexpr (kSlabs) __builtin_prefetch(side.slabs + parent);
}

template <bool kSlabs>
class Advancer {
 public:
  Advancer(const SearchStep& step, const SearchPose& pose, const Frontier& in, Frontier& out,
           SearchScratch& scratch)
      : step_(step), pose_(pose), in_(in), out_(out), scratch_(scratch) {}

  // Decodes a batch of groups, then tests it. So a vector is loaded long after the narrower stores
  // that wrote it, and short loops of varying length do not delay each other.
  std::uint64_t Run(SearchCursor& cursor) {
    while (cursor.group < in_.group_count) {
      Batch batch;
      if (cursor.row == 0) Gather(cursor.group, batch);
      if (batch.groups == 0) {
        if (!RowByRow(cursor)) break;
      } else {
        Test(batch);
        cursor.group += batch.groups;
      }
    }
    return tests_;
  }

 private:
  [[nodiscard]] std::uint32_t Begin(std::size_t group) const {
    return group == 0 ? 0 : in_.groups[group - 1].end;
  }
  [[nodiscard]] std::size_t MostLanes(std::size_t moving) const {
    return step_.moving.descends ? 8 * moving : moving;
  }

  HWY_INLINE std::size_t DecodeMoving(std::uint32_t begin, std::uint32_t end, std::size_t at) {
    const SearchSide side = step_.moving;  // a copy, which stores to lanes cannot alias
    const std::uint32_t* const ids = in_.moving;
    if (!HasBlocks(side)) {
      for (std::uint32_t i = begin; i < end; ++i) at += decode(side, ids[i], scratch_.moving, at);
      return at;
    }
    const std::size_t last = in_.moving_count - 1;
    for (std::uint32_t i = begin; i < end; ++i) {
      Prefetch<kSlabs>(side, ids[HWY_MIN(i + kAhead, last)]);
      at += DecodeBlock<kSlabs>(side, ids[i], scratch_.moving, at);
    }
    return at;
  }

  HWY_INLINE std::uint32_t DecodeFixed(std::size_t group, FixedRows& rows) {
    const SearchSide side = step_.fixed;
    const std::uint32_t node = in_.groups[group].fixed;
    if (HasBlocks(side)) {
      Prefetch<kSlabs>(side, in_.groups[HWY_MIN(group + 8, in_.group_count - 1)].fixed);
    }
    const std::uint32_t count = Decode<kSlabs>(side, node, scratch_.fixed, 0);
    Turn<kSlabs>(pose_, scratch_.fixed, rows);
    return count;
  }

  // Gathers as many groups from `first` on as fit the scratch memory and, whatever overlaps, `out`.
  void Gather(std::size_t first, Batch& batch) {
    std::size_t at = 0, rows = 0, most = 0;
    std::uint32_t begin = Begin(first);
    while (batch.groups < SearchScratch::kGroups && first + batch.groups < in_.group_count) {
      const SearchGroup group = in_.groups[first + batch.groups];
      at = (at + 15) & ~std::size_t{15};
      const std::size_t lanes = MostLanes(group.end - begin);
      rows += 8;
      most += 8 * lanes;
      if (at + lanes > MovingLanes::kSize || !has_room(out_, rows, most)) return;
      const std::size_t g = batch.groups++;
      batch.begin[g] = at;
      batch.end[g] = at = DecodeMoving(begin, group.end, at);
      batch.rows[g] = DecodeFixed(first + g, scratch_.rows[g]);
      batch.id[g] = scratch_.fixed.id[0];
      begin = group.end;
    }
  }

  void Test(const Batch& batch) {
    for (std::size_t g = 0; g < batch.groups; ++g) {
      for (std::uint32_t row = 0; row < batch.rows[g]; ++row) {
        const std::size_t before = out_.moving_count;
        out_.moving_count += OverlapRow<kSlabs>(scratch_.rows[g], row, scratch_.moving,
                                                batch.begin[g], batch.end[g], out_.moving + before);
        end_row(out_, batch.id[g] + row, before);
      }
      tests_ += batch.rows[g] * (batch.end[g] - batch.begin[g]);
    }
  }

  // Tests one group row by row: it has more moving nodes than the scratch memory holds, or `out` is
  // nearly full. Returns false when `out` is full.
  bool RowByRow(SearchCursor& cursor) {
    const SearchGroup group = in_.groups[cursor.group];
    const std::uint32_t begin = Begin(cursor.group);
    const std::uint32_t rows = DecodeFixed(cursor.group, scratch_.rows[0]);
    constexpr std::uint32_t kPiece = MovingLanes::kSize / 8;
    for (; cursor.row < rows; ++cursor.row) {
      if (!has_room(out_, 1, MostLanes(group.end - begin))) return false;
      const std::size_t before = out_.moving_count;
      for (std::uint32_t i = begin; i < group.end; i += kPiece) {
        const std::size_t end = DecodeMoving(i, HWY_MIN(i + kPiece, group.end), 0);
        out_.moving_count += OverlapRow<kSlabs>(scratch_.rows[0], cursor.row, scratch_.moving, 0,
                                                end, out_.moving + out_.moving_count);
        tests_ += end;
      }
      end_row(out_, scratch_.fixed.id[cursor.row], before);
    }
    ++cursor.group;
    cursor.row = 0;
    return true;
  }

  const SearchStep& step_;
  const SearchPose& pose_;
  const Frontier& in_;
  Frontier& out_;
  SearchScratch& scratch_;
  std::uint64_t tests_ = 0;
};

std::uint64_t Advance(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                      SearchCursor& cursor, Frontier& out, SearchScratch& scratch) {
  Frontier next = out;  // a copy, so that the compiler may keep it in registers
  const std::uint64_t tests = step.fixed.slabs != nullptr
                                  ? Advancer<true>(step, pose, in, next, scratch).Run(cursor)
                                  : Advancer<false>(step, pose, in, next, scratch).Run(cursor);
  out = next;
  return tests;
}

// Vector twin of ist::write_leaf_pairs_scalar.
void WriteLeafPairs(const Frontier& leaves, LeafPair* HWY_RESTRICT out) {
  const hn::CappedTag<std::uint64_t, 8> d;
  const hn::Rebind<std::uint32_t, decltype(d)> half;
  std::uint32_t begin = 0;
  for (std::size_t g = 0; g < leaves.group_count; ++g) {
    const SearchGroup group = leaves.groups[g];
    const auto fixed = hn::Set(d, std::uint64_t{group.fixed});
    for (std::uint32_t i = begin; i < group.end; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const auto moving = hn::PromoteTo(d, hn::LoadU(half, leaves.moving + i));
      hn::StoreU(hn::Or(fixed, hn::ShiftLeft<32>(moving)), d,
                 reinterpret_cast<std::uint64_t*>(out + i));
    }
    begin = group.end;
  }
}

// The parts of a step, each callable alone.
std::uint32_t DecodePart(const SearchSide& side, std::uint32_t node, MovingLanes& out,
                         std::size_t at) {
  return side.slabs != nullptr ? Decode<true>(side, node, out, at)
                               : Decode<false>(side, node, out, at);
}

void TurnPart(const SearchPose& pose, bool slabs, const FixedLanes& fixed, FixedRows& rows) {
  return slabs ? Turn<true>(pose, fixed, rows) : Turn<false>(pose, fixed, rows);
}

std::size_t OverlapRowPart(const FixedRows& rows, std::size_t row, const MovingLanes& moving,
                           std::size_t begin, std::size_t end, bool slabs, std::uint32_t* out) {
  return slabs ? OverlapRow<true>(rows, row, moving, begin, end, out)
               : OverlapRow<false>(rows, row, moving, begin, end, out);
}

std::size_t MeasureRowPart(const FixedRows& rows, std::size_t row, const MovingLanes& moving,
                           std::size_t begin, std::size_t end, bool slabs, std::uint32_t* out,
                           DistanceBounds& measure) {
  return slabs ? MeasureRow<true>(rows, row, moving, begin, end, out, measure)
               : MeasureRow<false>(rows, row, moving, begin, end, out, measure);
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <array>

namespace ist::simd {
namespace {

struct Compiled {
  std::int64_t bit;
  Kernels kernels;
};

// One target's kernels, or null where this compiler does not make them.
#define IST_KERNELS(NAME, TARGET)                                                     \
  Compiled {                                                                          \
    HWY_##TARGET, {                                                                   \
      NAME, HWY_CHOOSE_##TARGET(Advance), HWY_CHOOSE_##TARGET(WriteLeafPairs),        \
          {HWY_CHOOSE_##TARGET(DecodePart), HWY_CHOOSE_##TARGET(TurnPart),            \
           HWY_CHOOSE_##TARGET(OverlapRowPart), HWY_CHOOSE_##TARGET(MeasureRowPart)}, \
          HWY_CHOOSE_##TARGET(FindNear)                                               \
    }                                                                                 \
  }

constexpr std::array kCompiled = {IST_KERNELS("avx3", AVX3), IST_KERNELS("avx2", AVX2),
                                  IST_KERNELS("sse4", SSE4), IST_KERNELS("ssse3", SSSE3)};

#undef IST_KERNELS

}  // namespace

std::vector<Kernels> supported_kernels() {
  std::vector<Kernels> kernels;
  const std::int64_t supported = hwy::SupportedTargets();
  for (const Compiled& compiled : kCompiled) {
    if (compiled.kernels.advance != nullptr && (supported & compiled.bit) != 0) {
      kernels.push_back(compiled.kernels);
    }
  }
  return kernels;
}

}  // namespace ist::simd
#endif
