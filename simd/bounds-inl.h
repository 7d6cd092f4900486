// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_BOUNDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_BOUNDS_INL_H
#undef IST_SIMD_BOUNDS_INL_H
#else
#define IST_SIMD_BOUNDS_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "simd/lanes.h"

// Vector twins of the scalar forms in simd/lanes.h.
HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Full vectors for the tests; eight lanes, or as many as a vector has, for a block.
using Full = hn::ScalableTag<float>;
using Eight = hn::CappedTag<float, 8>;

// Read from memory: Highway 1.0.3's Iota stores its lanes one by one and then waits to load them.
alignas(64) constexpr std::uint32_t kLaneNumbers[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                        8, 9, 10, 11, 12, 13, 14, 15};

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
    hn::StoreU(hn::Add(hn::Set(du, first), hn::Load(du, kLaneNumbers + k)), du, out.id + at + k);
  }
  return child_count(side, parent);
}

// Vector twin of ist::turn, for a vector of rows from `k` on.
template <bool kSlabs, class D, class Lanes, class Rows>
HWY_INLINE void TurnAt(D d, const SearchPose& pose, const Pads& pads, const Lanes& fixed,
                       std::size_t k, Rows& rows) {
  using V = hn::Vec<D>;
  const auto load = [&](Lane lane) { return hn::LoadU(d, fixed.lane[lane] + k); };
  const auto dot = [&](int row, V x, V y, V z) {
    const float* r = pose.rotation + 3 * row;
    return hn::Add(hn::Add(hn::Mul(hn::Set(d, r[0]), x), hn::Mul(hn::Set(d, r[1]), y)),
                   hn::Mul(hn::Set(d, r[2]), z));
  };
  const auto x = load(kX), y = load(kY), z = load(kZ), radius = load(kRadius);
  hn::StoreU(hn::Add(dot(0, x, y, z), hn::Set(d, pose.translation[0])), d, rows.x + k);
  hn::StoreU(hn::Add(dot(1, x, y, z), hn::Set(d, pose.translation[1])), d, rows.y + k);
  hn::StoreU(hn::Add(dot(2, x, y, z), hn::Set(d, pose.translation[2])), d, rows.z + k);
  hn::StoreU(hn::Add(radius, hn::Set(d, pads.ball)), d, rows.radius + k);
  if constexpr (kSlabs) {
    const auto unscale = hn::Set(d, 1 / kSlabScale);
    const auto nx = hn::Mul(load(kNormalX), unscale), ny = hn::Mul(load(kNormalY), unscale),
               nz = hn::Mul(load(kNormalZ), unscale);
    hn::StoreU(dot(0, nx, ny, nz), d, rows.normal_x + k);
    hn::StoreU(dot(1, nx, ny, nz), d, rows.normal_y + k);
    hn::StoreU(dot(2, nx, ny, nz), d, rows.normal_z + k);
    hn::StoreU(hn::Mul(load(kOffset), unscale), d, rows.offset + k);
    hn::StoreU(hn::Add(hn::Mul(load(kHalf), unscale), hn::Set(d, pads.slab_fixed)), d,
               rows.half + k);
    hn::StoreU(hn::Mul(hn::Add(radius, hn::Set(d, pads.slab_moving)), hn::Set(d, kSlabScale)), d,
               rows.scaled_radius + k);
  }
}

// The same for all eight rows of a fixed node.
template <bool kSlabs>
HWY_INLINE void Turn(const SearchPose& pose, const Pads& pads, const FixedLanes& fixed,
                     FixedRows& rows) {
  const Eight d;
  for (std::size_t k = 0; k < 8; k += hn::Lanes(d)) TurnAt<kSlabs>(d, pose, pads, fixed, k, rows);
}

// Rows in vectors, one a lane: all lanes of the same row, or each lane of its own.
template <bool kSlabs>
struct RowVectors {
  using V = hn::Vec<Full>;
  V x, y, z, radius, normal_x, normal_y, normal_z, offset, half, scaled_radius;

  HWY_INLINE RowVectors(const FixedRows& f, std::size_t row)
      : RowVectors(f, [=](const float* of) { return hn::Set(Full(), of[row]); }) {}
  // `spread` makes a vector of one number of the rows.
  template <class Rows, class Spread>
  HWY_INLINE RowVectors(const Rows& f, const Spread& spread) {
    x = spread(f.x);
    y = spread(f.y);
    z = spread(f.z);
    radius = spread(f.radius);
    if constexpr (kSlabs) {
      normal_x = spread(f.normal_x);
      normal_y = spread(f.normal_y);
      normal_z = spread(f.normal_z);
      offset = spread(f.offset);
      half = spread(f.half);
      scaled_radius = spread(f.scaled_radius);
    }
  }
};

// Vector twin of ist::PairTest, for a row and a vector of moving lanes.
template <bool kSlabs>
struct VectorTest {
  using V = hn::Vec<Full>;
  V squared, radius_sum, over_fixed, fixed_sum, over_moving, moving_sum;

  template <class Lanes>
  HWY_INLINE VectorTest(const RowVectors<kSlabs>& f, const Lanes& m, std::size_t at) {
    const Full d;
    const auto load = [&](Lane lane) { return hn::Load(d, m.lane[lane] + at); };
    const V dx = hn::Sub(load(kX), f.x), dy = hn::Sub(load(kY), f.y), dz = hn::Sub(load(kZ), f.z);
    const auto dot = [&](V x, V y, V z) {
      return hn::Add(hn::Add(hn::Mul(dx, x), hn::Mul(dy, y)), hn::Mul(dz, z));
    };
    const V radius = load(kRadius);
    squared = dot(dx, dy, dz);
    radius_sum = hn::Add(radius, f.radius);
    if constexpr (kSlabs) {
      over_fixed = hn::Abs(hn::Sub(dot(f.normal_x, f.normal_y, f.normal_z), f.offset));
      fixed_sum = hn::Add(radius, f.half);
      over_moving =
          hn::Abs(hn::Add(dot(load(kNormalX), load(kNormalY), load(kNormalZ)), load(kOffset)));
      moving_sum = hn::Add(load(kHalf), f.scaled_radius);
    }
  }

  [[nodiscard]] HWY_INLINE hn::Mask<Full> Separate() const {
    auto separate = hn::Gt(squared, hn::Mul(radius_sum, radius_sum));
    if constexpr (kSlabs) {
      separate = hn::Or(separate, hn::Gt(over_fixed, fixed_sum));
      separate = hn::Or(separate, hn::Gt(over_moving, moving_sum));
    }
    return separate;
  }

  [[nodiscard]] HWY_INLINE V Apart(V distance) const {
    const Full d;
    V apart = hn::Sub(distance, radius_sum);
    if constexpr (kSlabs) {
      // Where a NaN cannot be compared, x86's max takes its second operand.
      apart = hn::Max(hn::Sub(over_fixed, fixed_sum), apart);
      apart = hn::Max(hn::Mul(hn::Sub(over_moving, moving_sum), hn::Set(d, 1 / kSlabScale)), apart);
    }
    return apart;
  }
};

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
