// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_ADVANCE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_ADVANCE_INL_H
#undef IST_SIMD_ADVANCE_INL_H
#else
#define IST_SIMD_ADVANCE_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "ist/base/set_bits.h"
#include "ist/tree/lookup_table.h"
#include "simd/bounds-inl.h"
#include "simd/lanes.h"
#include "simd/measure-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Vectors of four lanes look up one by one anyway: there the scalar form is faster.
constexpr bool kDecodesImplicit = hn::MaxLanes(Eight()) == 8;

// Vector twin of ist::decode for a side that descends and has no blocks. One object keeps what the
// nodes of a side share in registers. Reads kMaskSpare bytes behind the masks of a level.
class ImplicitDecoder {
 public:
  HWY_INLINE explicit ImplicitDecoder(const SearchSide& side)
      : nodes_(side.nodes),
        masks_(side.masks),
        child_masks_(side.implicit->masks),
        emits_slots_(side.emits_slots),
        voxel_size_(hn::Set(d, side.voxel_size)),
        octant_offset_(hn::Set(d, side.octant_offset)),
        circumradius_(hn::Set(d, side.implicit->radius[kCircumsphereCode])),
        offsets_(hn::Load(d, side.implicit->offset)),
        radii_(hn::Load(d, side.implicit->radius)) {}

  template <std::size_t N>
  HWY_INLINE std::uint32_t Decode(std::uint32_t parent, BoundLanes<N>& out, std::size_t at) const {
    const OctreeNode& node = nodes_[parent];
    const auto octants = hn::PromoteTo(du, hn::LoadU(bytes, kSetBits[masks_[parent]].data()));
    auto x = Place(node.centre[0], hn::ShiftLeft<31>(octants)),
         y = Place(node.centre[1], hn::ShiftLeft<30>(octants)),
         z = Place(node.centre[2], hn::ShiftLeft<29>(octants)), radius = circumradius_;
    if (child_masks_ != nullptr) {
      const auto masks = hn::PromoteTo(di, hn::LoadU(bytes, child_masks_ + node.first_child));
      const auto words = hn::GatherIndex(du, kTableWords.data(), masks);
      const auto code = hn::Set(du, 7);
      x = hn::Add(x, LookUp(offsets_, hn::And(words, code)));
      y = hn::Add(y, LookUp(offsets_, hn::And(hn::ShiftRight<3>(words), code)));
      z = hn::Add(z, LookUp(offsets_, hn::And(hn::ShiftRight<6>(words), code)));
      radius = LookUp(radii_, hn::ShiftRight<9>(words));
    }
    hn::StoreU(x, d, out.lane[kX] + at);
    hn::StoreU(y, d, out.lane[kY] + at);
    hn::StoreU(z, d, out.lane[kZ] + at);
    hn::StoreU(radius, d, out.lane[kRadius] + at);
    const std::uint32_t first = emits_slots_ ? 8 * parent : node.first_child;
    hn::StoreU(hn::Add(hn::Set(du, first), hn::Load(du, kLaneNumbers)), du, out.id + at);
    return nodes_[parent + 1].first_child - node.first_child;
  }

 private:
  static constexpr Eight d{};
  static constexpr hn::Rebind<std::uint32_t, Eight> du{};
  static constexpr hn::Rebind<std::int32_t, Eight> di{};
  static constexpr hn::Rebind<std::uint8_t, Eight> bytes{};
  using Floats = hn::Vec<Eight>;
  using Words = hn::Vec<hn::Rebind<std::uint32_t, Eight>>;

  // The highest bit of `octants`, set for the upper half, becomes the sign of what is subtracted.
  HWY_INLINE Floats Place(float centre, Words octants) const {
    return hn::Sub(hn::Mul(hn::Set(d, centre), voxel_size_),
                   hn::CopySignToAbs(octant_offset_, hn::BitCast(d, octants)));
  }
  HWY_INLINE static Floats LookUp(Floats lengths, Words codes) {
    return hn::TableLookupLanes(lengths, hn::IndicesFromVec(d, codes));
  }

  const OctreeNode* nodes_;
  const std::uint8_t *masks_, *child_masks_;
  bool emits_slots_;
  Floats voxel_size_, octant_offset_, circumradius_, offsets_, radii_;
};

// Returns whether the vector forms of a decode apply; otherwise ist::decode does.
HWY_INLINE bool HasVectorForm(const SearchSide& side) {
  return side.descends && (kDecodesImplicit || side.balls != nullptr);
}

// Vector twin of ist::decode where a vector form applies, and ist::decode elsewhere.
template <bool kSlabs, std::size_t N>
HWY_INLINE std::uint32_t Decode(const SearchSide& side, std::uint32_t node, BoundLanes<N>& out,
                                std::size_t at) {
  if (!HasVectorForm(side)) return decode(side, node, out, at);
  if constexpr (kDecodesImplicit && !kSlabs) {
    if (side.balls == nullptr) return ImplicitDecoder(side).Decode(node, out, at);
  }
  return DecodeBlock<kSlabs>(side, node, out, at);
}

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

HWY_INLINE void PrefetchMasks(const SearchSide& side, std::uint32_t parent) {
  __builtin_prefetch(side.nodes + parent);
  __builtin_prefetch(side.masks + parent);
}

template <bool kSlabs, class Rows>
class Advancer {
 public:
  Advancer(const SearchStep& step, const SearchPose& pose, const Frontier& in, const Rows& out,
           SearchScratch& scratch, std::uint64_t most, DistanceBounds& bounds)
      : step_(step),
        pose_(pose),
        in_(in),
        out_(out),
        scratch_(scratch),
        most_(most),
        measurer_(bounds, step.radius_limit + pads_of(pose, step).ball) {}

  // Decodes a batch of groups, then tests it. So a vector is loaded long after the narrower stores
  // that wrote it, and short loops of varying length do not delay each other.
  Advanced Run(SearchCursor& cursor) {
    while (cursor.group < in_.group_count) {
      Batch batch;
      if (cursor.row == 0 && cursor.moving == 0) Gather(cursor.group, batch);
      if (batch.groups == 0) {
        if (tests_ > 0 && cursor.row == 0 && cursor.moving == 0 &&
            !Affordable(in_.groups[cursor.group], Begin(cursor.group), tests_)) {
          break;
        }
        const Stop stop = RowByRow(cursor);
        if (stop != Stop::kNot) return {tests_, stop == Stop::kFull};
      } else {
        Test(batch);
        cursor.group += batch.groups;
      }
    }
    return {tests_, false};
  }

 private:
  enum class Stop { kNot, kFull, kSpent };

  [[nodiscard]] std::uint32_t Begin(std::size_t group) const {
    return group == 0 ? 0 : in_.groups[group - 1].end;
  }
  [[nodiscard]] std::size_t MostLanes(std::size_t moving) const {
    return step_.moving.descends ? 8 * moving : moving;
  }

  HWY_INLINE std::size_t DecodeMoving(std::uint32_t begin, std::uint32_t end, std::size_t at) {
    const std::uint32_t* const ids = in_.moving;
    const std::size_t last = in_.moving_count - 1;
    if constexpr (kDecodesImplicit && !kSlabs) {
      if (step_.moving.descends && step_.moving.balls == nullptr) {
        const ImplicitDecoder decoder(step_.moving);
        for (std::uint32_t i = begin; i < end; ++i) {
          PrefetchMasks(step_.moving, ids[HWY_MIN(i + kAhead, last)]);
          at += decoder.Decode(ids[i], scratch_.moving, at);
        }
        return at;
      }
    }
    const SearchSide side = step_.moving;  // a copy, which stores to lanes cannot alias
    if (!HasVectorForm(side)) {
      for (std::uint32_t i = begin; i < end; ++i) at += decode(side, ids[i], scratch_.moving, at);
      return at;
    }
    for (std::uint32_t i = begin; i < end; ++i) {
      Prefetch<kSlabs>(side, ids[HWY_MIN(i + kAhead, last)]);
      at += DecodeBlock<kSlabs>(side, ids[i], scratch_.moving, at);
    }
    return at;
  }

  HWY_INLINE std::uint32_t DecodeFixed(std::size_t group, std::size_t g) {
    const SearchSide& side = step_.fixed;
    const std::uint32_t node = in_.groups[group].fixed;
    if (side.descends) {
      const std::uint32_t ahead = in_.groups[HWY_MIN(group + 8, in_.group_count - 1)].fixed;
      side.balls != nullptr ? Prefetch<kSlabs>(side, ahead) : PrefetchMasks(side, ahead);
    }
    FixedGroup& fixed = scratch_.fixed[g];
    const std::uint32_t count = Decode<kSlabs>(side, node, fixed.lanes, 0);
    Turn<kSlabs>(pose_, pads_of(pose_, step_), fixed.lanes, fixed.rows);
    out_.Decoded(node, fixed);
    return count;
  }

  // Returns whether the tests of a group stay within the limit.
  [[nodiscard]] bool Affordable(const SearchGroup& group, std::uint32_t begin,
                                std::uint64_t tests) const {
    if (HWY_LIKELY(8 * MostLanes(group.end - begin) <= most_ - tests)) return true;
    std::uint64_t lanes = 0;
    for (std::uint32_t i = begin; i < group.end; ++i) lanes += opened(step_.moving, in_.moving[i]);
    return opened(step_.fixed, group.fixed) * lanes <= most_ - tests;
  }

  // Gathers as many groups from `first` on as fit the scratch memory, the limit of tests and,
  // whatever overlaps, `out`.
  void Gather(std::size_t first, Batch& batch) {
    std::size_t at = 0, rows = 0, most = 0;
    std::uint64_t tests = tests_;
    std::uint32_t begin = Begin(first);
    while (batch.groups < SearchScratch::kGroups && first + batch.groups < in_.group_count) {
      const SearchGroup group = in_.groups[first + batch.groups];
      at = (at + 15) & ~std::size_t{15};
      const std::size_t lanes = MostLanes(group.end - begin);
      rows += 8;
      most += 8 * lanes;
      if (at + lanes > MovingLanes::kSize || !out_.HasRoom(rows, most) ||
          !Affordable(group, begin, tests)) {
        return;
      }
      const std::size_t g = batch.groups++;
      batch.begin[g] = at;
      batch.end[g] = at = DecodeMoving(begin, group.end, at);
      batch.rows[g] = DecodeFixed(first + g, g);
      batch.id[g] = scratch_.fixed[g].lanes.id[0];
      tests += batch.rows[g] * (batch.end[g] - batch.begin[g]);
      begin = group.end;
    }
  }

  void Test(const Batch& batch) {
    for (std::size_t g = 0; g < batch.groups; ++g) {
      const FixedGroup& fixed = scratch_.fixed[g];
      for (std::uint32_t row = 0; row < batch.rows[g]; ++row) {
        const std::size_t before = out_.Begin();
        out_.Test(fixed, row, scratch_.moving, batch.begin[g], batch.end[g], measurer_);
        out_.End(batch.id[g] + row, before);
      }
      tests_ += batch.rows[g] * (batch.end[g] - batch.begin[g]);
    }
  }

  // Tests one group piece by piece: it has more moving nodes than the scratch memory holds, or
  // `out` is nearly full, or the limit is near.
  Stop RowByRow(SearchCursor& cursor) {
    const SearchGroup group = in_.groups[cursor.group];
    const std::uint32_t begin = Begin(cursor.group);
    const std::uint32_t rows = DecodeFixed(cursor.group, 0);
    const bool whole = group.end - begin <= kPieceNodes;
    std::size_t lanes = whole ? DecodeMoving(begin, group.end, 0) : 0;
    for (; cursor.row < rows; ++cursor.row, cursor.moving = 0) {
      const std::uint32_t fixed = scratch_.fixed[0].lanes.id[cursor.row];
      while (begin + cursor.moving < group.end) {
        const std::uint32_t first = begin + cursor.moving;
        if ((step_.last || cursor.moving == 0) &&
            !out_.HasRoom(1, room_of_row(step_, group.end - first))) {
          return Stop::kFull;
        }
        const std::uint32_t end = HWY_MIN(first + kPieceNodes, group.end);
        if (!whole) lanes = DecodeMoving(first, end, 0);
        if (lanes > most_ - tests_) return Stop::kSpent;
        const std::size_t before = cursor.moving == 0 ? out_.Begin() : out_.Continue(fixed);
        out_.Test(scratch_.fixed[0], cursor.row, scratch_.moving, 0, lanes, measurer_);
        tests_ += lanes;
        out_.End(fixed, before);
        cursor.moving = end - begin;
      }
    }
    ++cursor.group;
    cursor.row = 0;
    return Stop::kNot;
  }

  const SearchStep& step_;
  const SearchPose& pose_;
  const Frontier& in_;
  Rows out_;
  SearchScratch& scratch_;
  const std::uint64_t most_;
  Measurer<kSlabs> measurer_;
  std::uint64_t tests_ = 0;
};

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
