#include "simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "ist/query/bound_lanes.h"
#include "simd/select-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Full vectors for the tests; eight lanes, or as many as there are, for a block.
using Full = hn::ScalableTag<float>;
using Eight = hn::CappedTag<float, 8>;

// Blocks that are met so many places later are fetched now: time enough for memory, not so much
// that they are gone again.
constexpr std::size_t kAhead = 24;

// Read from memory: Highway 1.0.3's Iota writes its lanes there one by one, and waits for them.
alignas(64) constexpr std::uint32_t kSlots[8] = {0, 1, 2, 3, 4, 5, 6, 7};

template <typename Integer>
HWY_INLINE hn::Vec<Eight> FloatsOf(const Integer* HWY_RESTRICT values) {
  const Eight d;
  const hn::Rebind<std::int32_t, Eight> wide;
  const hn::Rebind<Integer, Eight> narrow;
  return hn::ConvertTo(d, hn::PromoteTo(wide, hn::LoadU(narrow, values)));
}

// Vector twin of ist::decode for a side that is opened and has blocks.
template <bool kSlabs, std::size_t N>
HWY_INLINE std::uint32_t DecodeBlock(const SearchSide& side, std::uint32_t parent,
                                     BoundLanes<N>& out, std::size_t at) {
  const Eight d;
  const hn::Rebind<std::uint32_t, Eight> du;
  const OctreeNode& node = side.nodes[parent];
  const BallBlock& ball = side.balls[parent];
  const auto unit = hn::Set(d, side.ball_unit);
  const std::uint32_t first = side.names_addresses ? 8 * parent : node.first_child;
  for (std::size_t k = 0; k < 8; k += hn::Lanes(d)) {
    const auto store = [&](Lane lane, hn::Vec<Eight> v) {
      hn::StoreU(v, d, out.lane[lane] + at + k);
    };
    const auto place = [&](int axis, const std::int16_t* q) {
      return hn::Add(hn::Set(d, node.centre[axis] * side.voxel_size),
                     hn::Mul(FloatsOf(q + k), unit));
    };
    store(kX, place(0, ball.x));
    store(kY, place(1, ball.y));
    store(kZ, place(2, ball.z));
    store(kRadius, hn::Mul(FloatsOf(ball.r + k), unit));
    if constexpr (kSlabs) {
      const SlabBlock& slab = side.slabs[parent];
      const auto slab_unit = hn::Set(d, side.slab_unit);
      store(kNormalX, FloatsOf(slab.nx + k));
      store(kNormalY, FloatsOf(slab.ny + k));
      store(kNormalZ, FloatsOf(slab.nz + k));
      store(kOffset, hn::Mul(FloatsOf(slab.offset + k), slab_unit));
      store(kHalf, hn::Mul(FloatsOf(slab.half + k), slab_unit));
    }
    hn::StoreU(hn::Add(hn::Set(du, first), hn::Load(du, kSlots + k)), du, out.name + at + k);
  }
  return child_count(side, parent);
}

// What has no blocks, or is not opened, is the scalar form's.
HWY_INLINE bool HasBlocks(const SearchSide& side) { return side.opens && side.balls != nullptr; }

template <bool kSlabs, std::size_t N>
HWY_INLINE std::uint32_t Decode(const SearchSide& side, std::uint32_t node, BoundLanes<N>& out,
                                std::size_t at) {
  return HasBlocks(side) ? DecodeBlock<kSlabs>(side, node, out, at) : decode(side, node, out, at);
}

// Vector twin of ist::turn, for all eight rows.
template <bool kSlabs>
HWY_INLINE void Turn(const SearchPose& pose, const FixedLanes& fixed, FixedRows& rows) {
  const Eight d;
  for (std::size_t k = 0; k < 8; k += hn::Lanes(d)) {
    const auto load = [&](Lane lane) { return hn::LoadU(d, fixed.lane[lane] + k); };
    const auto dot = [&](int row, hn::Vec<Eight> x, hn::Vec<Eight> y, hn::Vec<Eight> z) {
      const float* r = pose.rotation + 3 * row;
      return hn::Add(hn::Add(hn::Mul(hn::Set(d, r[0]), x), hn::Mul(hn::Set(d, r[1]), y)),
                     hn::Mul(hn::Set(d, r[2]), z));
    };
    const auto x = load(kX), y = load(kY), z = load(kZ), radius = load(kRadius);
    hn::StoreU(hn::Add(dot(0, x, y, z), hn::Set(d, pose.translation[0])), d, rows.x + k);
    hn::StoreU(hn::Add(dot(1, x, y, z), hn::Set(d, pose.translation[1])), d, rows.y + k);
    hn::StoreU(hn::Add(dot(2, x, y, z), hn::Set(d, pose.translation[2])), d, rows.z + k);
    hn::StoreU(hn::Add(radius, hn::Set(d, pose.ball_pad)), d, rows.radius + k);
    if constexpr (kSlabs) {
      const auto unscale = hn::Set(d, 1 / kSlabScale), pad = hn::Set(d, pose.slab_pad);
      const auto nx = hn::Mul(load(kNormalX), unscale), ny = hn::Mul(load(kNormalY), unscale),
                 nz = hn::Mul(load(kNormalZ), unscale);
      hn::StoreU(dot(0, nx, ny, nz), d, rows.normal_x + k);
      hn::StoreU(dot(1, nx, ny, nz), d, rows.normal_y + k);
      hn::StoreU(dot(2, nx, ny, nz), d, rows.normal_z + k);
      hn::StoreU(hn::Mul(load(kOffset), unscale), d, rows.offset + k);
      hn::StoreU(hn::Add(hn::Mul(load(kHalf), unscale), pad), d, rows.half + k);
      hn::StoreU(hn::Mul(hn::Add(radius, pad), hn::Set(d, kSlabScale)), d, rows.scaled_radius + k);
    }
  }
}

// Vector twin of ist::touch: one row against the moving lanes [begin, end), begin at a multiple of
// the vector. Writes the names of those that touch to `out` and returns how many; a vector's worth
// of room is needed behind them.
template <bool kSlabs>
HWY_INLINE std::size_t TouchRow(const FixedRows& f, std::size_t row, const MovingLanes& m,
                                std::size_t begin, std::size_t end,
                                std::uint32_t* HWY_RESTRICT out) {
  const Full d;
  const hn::RebindToUnsigned<Full> du;
  const auto x = hn::Set(d, f.x[row]), y = hn::Set(d, f.y[row]), z = hn::Set(d, f.z[row]);
  const auto radius = hn::Set(d, f.radius[row]);
  hn::Vec<Full> nx, ny, nz, offset, half, scaled_radius;
  if constexpr (kSlabs) {
    nx = hn::Set(d, f.normal_x[row]);
    ny = hn::Set(d, f.normal_y[row]);
    nz = hn::Set(d, f.normal_z[row]);
    offset = hn::Set(d, f.offset[row]);
    half = hn::Set(d, f.half[row]);
    scaled_radius = hn::Set(d, f.scaled_radius[row]);
  }
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
    const auto load = [&](Lane lane) { return hn::Load(d, m.lane[lane] + i); };
    const auto dx = hn::Sub(load(kX), x), dy = hn::Sub(load(kY), y), dz = hn::Sub(load(kZ), z);
    const auto r = load(kRadius);
    const auto reach = hn::Add(r, radius);
    const auto squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    auto apart = hn::Gt(squared, hn::Mul(reach, reach));
    if constexpr (kSlabs) {
      const auto above_fixed =
          hn::Sub(hn::Add(hn::Add(hn::Mul(dx, nx), hn::Mul(dy, ny)), hn::Mul(dz, nz)), offset);
      apart = hn::Or(apart, hn::Gt(hn::Abs(above_fixed), hn::Add(r, half)));
      const auto above_moving =
          hn::Add(hn::Add(hn::Add(hn::Mul(dx, load(kNormalX)), hn::Mul(dy, load(kNormalY))),
                          hn::Mul(dz, load(kNormalZ))),
                  load(kOffset));
      apart = hn::Or(apart, hn::Gt(hn::Abs(above_moving), hn::Add(load(kHalf), scaled_radius)));
    }
    const auto touching = hn::AndNot(apart, hn::FirstN(d, end - i));
    count += StoreSelected(d, touching, hn::Load(du, m.name + i), out + count);
  }
  return count;
}

// Where the groups of a batch lie in the scratch memory.
struct Batch {
  std::size_t groups = 0;
  std::size_t begin[SearchScratch::kGroups], end[SearchScratch::kGroups];
  std::uint32_t rows[SearchScratch::kGroups], name[SearchScratch::kGroups];
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

  // Some groups at a time: all are decoded, then all are tested. So a vector is loaded long after
  // the narrower stores that wrote it, and short loops of changing length do not stop each other.
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
    return step_.moving.opens ? 8 * moving : moving;
  }

  HWY_INLINE std::size_t DecodeMoving(std::uint32_t begin, std::uint32_t end, std::size_t at) {
    const SearchSide side = step_.moving;  // a copy, which the lanes' stores cannot change
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

  // As many groups from `first` on as fit into the scratch memory and surely into `out`.
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
      batch.name[g] = scratch_.fixed.name[0];
      begin = group.end;
    }
  }

  void Test(const Batch& batch) {
    for (std::size_t g = 0; g < batch.groups; ++g) {
      for (std::uint32_t row = 0; row < batch.rows[g]; ++row) {
        const std::size_t before = out_.moving_count;
        out_.moving_count += TouchRow<kSlabs>(scratch_.rows[g], row, scratch_.moving,
                                              batch.begin[g], batch.end[g], out_.moving + before);
        end_row(out_, batch.name[g] + row, before);
      }
      tests_ += batch.rows[g] * (batch.end[g] - batch.begin[g]);
    }
  }

  // One group with more moving nodes than the scratch memory holds, or when `out` is nearly full.
  // False when it is full.
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
        out_.moving_count += TouchRow<kSlabs>(scratch_.rows[0], cursor.row, scratch_.moving, 0, end,
                                              out_.moving + out_.moving_count);
        tests_ += end;
      }
      end_row(out_, scratch_.fixed.name[cursor.row], before);
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

// Vector twin of ist::write_contacts_scalar.
void WriteContacts(const Frontier& leaves, Contact* HWY_RESTRICT out) {
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

// The parts, each for itself.
std::uint32_t DecodePart(const SearchSide& side, std::uint32_t node, MovingLanes& out,
                         std::size_t at) {
  return side.slabs != nullptr ? Decode<true>(side, node, out, at)
                               : Decode<false>(side, node, out, at);
}

void TurnPart(const SearchPose& pose, bool slabs, const FixedLanes& fixed, FixedRows& rows) {
  return slabs ? Turn<true>(pose, fixed, rows) : Turn<false>(pose, fixed, rows);
}

std::size_t TouchRowPart(const FixedRows& rows, std::size_t row, const MovingLanes& moving,
                         std::size_t begin, std::size_t end, bool slabs, std::uint32_t* out) {
  return slabs ? TouchRow<true>(rows, row, moving, begin, end, out)
               : TouchRow<false>(rows, row, moving, begin, end, out);
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

// One target's functions, or null where this compiler does not make them.
#define IST_KERNELS(NAME, TARGET)                                               \
  Compiled {                                                                    \
    HWY_##TARGET, {                                                             \
      NAME, HWY_CHOOSE_##TARGET(Advance), HWY_CHOOSE_##TARGET(WriteContacts), { \
        HWY_CHOOSE_##TARGET(DecodePart), HWY_CHOOSE_##TARGET(TurnPart),         \
            HWY_CHOOSE_##TARGET(TouchRowPart)                                   \
      }                                                                         \
    }                                                                           \
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
