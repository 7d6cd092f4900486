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

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
