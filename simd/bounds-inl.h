// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_BOUNDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_BOUNDS_INL_H
#undef IST_SIMD_BOUNDS_INL_H
#else
#define IST_SIMD_BOUNDS_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <limits>

#include "simd/lanes.h"
#include "simd/select-inl.h"

// Vector twins of the scalar forms in simd/lanes.h.
HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Full vectors for the tests; eight lanes, or as many as a vector has, for a block.
using Full = hn::ScalableTag<float>;
using Eight = hn::CappedTag<float, 8>;

// Read from memory: Highway 1.0.3's Iota stores its lanes one by one and then waits to load them.
alignas(64) constexpr std::uint32_t kSlots[8] = {0, 1, 2, 3, 4, 5, 6, 7};

template <typename Integer>
HWY_INLINE hn::Vec<Eight> FloatsOf(const Integer* HWY_RESTRICT values) {
  const Eight d;
  const hn::Rebind<std::int32_t, Eight> wide;
  const hn::Rebind<Integer, Eight> narrow;
  return hn::ConvertTo(d, hn::PromoteTo(wide, hn::LoadU(narrow, values)));
}

// Vector twin of ist::decode for a side that descends and has blocks.
template <bool kSlabs, std::size_t N>
HWY_INLINE std::uint32_t DecodeBlock(const SearchSide& side, std::uint32_t parent,
                                     BoundLanes<N>& out, std::size_t at) {
  const Eight d;
  const hn::Rebind<std::uint32_t, Eight> du;
  const OctreeNode& node = side.nodes[parent];
  const BallBlock& ball = side.balls[parent];
  const auto unit = hn::Set(d, side.ball_unit);
  const std::uint32_t first = side.emits_slots ? 8 * parent : node.first_child;
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
    hn::StoreU(hn::Add(hn::Set(du, first), hn::Load(du, kSlots + k)), du, out.id + at + k);
  }
  return child_count(side, parent);
}

// Returns whether the vector form applies: a side without blocks, or one that does not descend,
// takes the scalar form.
HWY_INLINE bool HasBlocks(const SearchSide& side) { return side.descends && side.balls != nullptr; }

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

// Vector twin of ist::overlap: tests one row against the moving lanes [begin, end), begin at a
// multiple of the vector. Writes the ids of the overlapping lanes to `out` and returns their
// number; needs a vector's worth of room behind them.
template <bool kSlabs>
HWY_INLINE std::size_t OverlapRow(const FixedRows& f, std::size_t row, const MovingLanes& m,
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
    const auto radius_sum = hn::Add(r, radius);
    const auto squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    auto apart = hn::Gt(squared, hn::Mul(radius_sum, radius_sum));
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
    const auto overlapping = hn::AndNot(apart, hn::FirstN(d, end - i));
    count += StoreSelected(d, overlapping, hn::Load(du, m.id + i), out + count);
  }
  return count;
}

// Vector twin of ist::measure, for a row as in OverlapRow. Where a NaN cannot be compared, x86's
// min takes its second operand, here the value so far.
template <bool kSlabs>
HWY_INLINE std::size_t MeasureRow(const FixedRows& f, std::size_t row, const MovingLanes& m,
                                  std::size_t begin, std::size_t end,
                                  std::uint32_t* HWY_RESTRICT out, DistanceBounds& measure) {
  const Full d;
  const hn::RebindToUnsigned<Full> du;
  const auto set = [&](const float* numbers) { return hn::Set(d, numbers[row]); };
  const auto none = hn::Set(d, std::numeric_limits<float>::infinity());
  auto pruned = none, overlapping = none, farthest = none;
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
    const auto load = [&](Lane lane) { return hn::Load(d, m.lane[lane] + i); };
    const auto dx = hn::Sub(load(kX), set(f.x)), dy = hn::Sub(load(kY), set(f.y)),
               dz = hn::Sub(load(kZ), set(f.z));
    const auto dot = [&](hn::Vec<Full> x, hn::Vec<Full> y, hn::Vec<Full> z) {
      return hn::Add(hn::Add(hn::Mul(dx, x), hn::Mul(dy, y)), hn::Mul(dz, z));
    };
    const auto r = load(kRadius), radius_sum = hn::Add(r, set(f.radius));
    const auto squared = dot(dx, dy, dz), distance = hn::Sqrt(squared);
    auto separate = hn::Gt(squared, hn::Mul(radius_sum, radius_sum));
    auto apart = hn::Sub(distance, radius_sum);
    if constexpr (kSlabs) {
      const auto high =
          hn::Abs(hn::Sub(dot(set(f.normal_x), set(f.normal_y), set(f.normal_z)), set(f.offset)));
      const auto high_sum = hn::Add(r, set(f.half));
      separate = hn::Or(separate, hn::Gt(high, high_sum));
      apart = hn::Max(hn::Sub(high, high_sum), apart);
      const auto over =
          hn::Abs(hn::Add(dot(load(kNormalX), load(kNormalY), load(kNormalZ)), load(kOffset)));
      const auto over_sum = hn::Add(load(kHalf), set(f.scaled_radius));
      separate = hn::Or(separate, hn::Gt(over, over_sum));
      apart = hn::Max(hn::Mul(hn::Sub(over, over_sum), hn::Set(d, 1 / kSlabScale)), apart);
    }
    const auto here = hn::FirstN(d, end - i);
    pruned = hn::Min(hn::IfThenElse(hn::And(here, separate), apart, none), pruned);
    overlapping = hn::Min(hn::IfThenElse(hn::AndNot(separate, here), apart, none), overlapping);
    farthest = hn::Min(hn::IfThenElse(here, hn::Add(distance, radius_sum), none), farthest);
    count += StoreSelected(d, hn::AndNot(separate, here), hn::Load(du, m.id + i), out + count);
  }
  const auto least = [&](float& so_far, hn::Vec<Full> v) {
    so_far = HWY_MIN(so_far, hn::GetLane(hn::MinOfLanes(d, v)));
  };
  least(measure.min_pruned, pruned);
  least(measure.min_overlapping, overlapping);
  least(measure.upper, farthest);
  return count;
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
