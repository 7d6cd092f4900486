// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_IMPLICIT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_IMPLICIT_INL_H
#undef IST_SIMD_IMPLICIT_INL_H
#else
#define IST_SIMD_IMPLICIT_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "ist/base/set_bits.h"
#include "ist/tree/lookup_table.h"
#include "simd/bounds-inl.h"
#include "simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Vectors of four lanes look up one by one anyway: there the scalar form is faster.
constexpr bool kDecodesImplicit = hn::MaxLanes(Eight()) == 8;

// Vector twin of ist::decode for a side that descends and has no blocks. Reads kMaskSpare bytes
// behind the masks of a level.
template <std::size_t N>
HWY_INLINE std::uint32_t DecodeImplicit(const SearchSide& side, std::uint32_t parent,
                                        BoundLanes<N>& out, std::size_t at) {
  const Eight d;
  const hn::Rebind<std::uint32_t, Eight> du;
  const hn::Rebind<std::int32_t, Eight> di;
  const hn::Rebind<std::uint8_t, Eight> bytes;
  const OctreeNode& node = side.nodes[parent];
  const ImplicitLevel& level = *side.implicit;
  const auto octants = hn::PromoteTo(du, hn::LoadU(bytes, kSetBits[side.masks[parent]].data()));
  const auto offset = hn::Set(d, level.octant_offset);
  // The octant's bit becomes the sign of what is subtracted: set for the upper half.
  const auto place = [&](int axis, auto bit) {
    return hn::Sub(hn::Set(d, node.centre[axis] * side.voxel_size),
                   hn::CopySignToAbs(offset, hn::BitCast(d, bit)));
  };
  auto x = place(0, hn::ShiftLeft<31>(octants)), y = place(1, hn::ShiftLeft<30>(octants)),
       z = place(2, hn::ShiftLeft<29>(octants));
  auto radius = hn::Set(d, level.radius[kCircumsphereCode]);
  if (side.child_masks != nullptr) {
    const auto masks = hn::PromoteTo(di, hn::LoadU(bytes, side.child_masks + node.first_child));
    const auto words = hn::GatherIndex(du, kTableWords.data(), masks);
    const auto look_up = [&](const float* lengths, auto codes) {
      return hn::TableLookupLanes(hn::Load(d, lengths), hn::IndicesFromVec(d, codes));
    };
    const auto low = hn::Set(du, 7);
    x = hn::Add(x, look_up(level.offset, hn::And(words, low)));
    y = hn::Add(y, look_up(level.offset, hn::And(hn::ShiftRight<3>(words), low)));
    z = hn::Add(z, look_up(level.offset, hn::And(hn::ShiftRight<6>(words), low)));
    radius = look_up(level.radius, hn::ShiftRight<9>(words));
  }
  hn::StoreU(x, d, out.lane[kX] + at);
  hn::StoreU(y, d, out.lane[kY] + at);
  hn::StoreU(z, d, out.lane[kZ] + at);
  hn::StoreU(radius, d, out.lane[kRadius] + at);
  const std::uint32_t first = side.emits_slots ? 8 * parent : node.first_child;
  hn::StoreU(hn::Add(hn::Set(du, first), hn::Load(du, kSlots)), du, out.id + at);
  return child_count(side, parent);
}

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
    if (side.balls == nullptr) return DecodeImplicit(side, node, out, at);
  }
  return DecodeBlock<kSlabs>(side, node, out, at);
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
