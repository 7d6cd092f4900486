// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_SELECT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_SELECT_INL_H
#undef IST_SIMD_SELECT_INL_H
#else
#define IST_SIMD_SELECT_INL_H
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstdint>

#include "ist/base/set_bits.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Stores the selected ids side by side and returns their number. Writes a whole vector. (Highway
// 1.0.3's Compress copies its table at every call on AVX2, so only AVX-512 uses it.)
template <class D>
HWY_INLINE std::size_t StoreSelected(D d, hn::Mask<D> selected,
                                     hn::Vec<hn::RebindToUnsigned<D>> names,
                                     std::uint32_t* HWY_RESTRICT out) {
  const hn::RebindToUnsigned<D> du;
  if constexpr (hn::MaxLanes(d) == 16) {
    hn::StoreU(hn::Compress(names, hn::RebindMask(du, selected)), du, out);
    return hn::CountTrue(d, selected);
  } else {
    std::uint8_t bits[8];
    hn::StoreMaskBits(d, selected, bits);
    if constexpr (hn::MaxLanes(d) == 1) {
      hn::StoreU(names, du, out);
    } else {
      const hn::Rebind<std::uint8_t, decltype(du)> bytes;
      const auto order = hn::PromoteTo(du, hn::LoadU(bytes, kSetBits[bits[0]].data()));
      hn::StoreU(hn::TableLookupLanes(names, hn::IndicesFromVec(du, order)), du, out);
    }
    return static_cast<std::size_t>(std::popcount(bits[0]));
  }
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
