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

// The lanes that a mask selects, to be stored side by side. (Highway 1.0.3's Compress copies its
// table at every call on AVX2, so only AVX-512 uses it.)
template <class D>
class Selected {
 public:
  static constexpr bool kCompress = hn::MaxLanes(D()) == 16;

  HWY_INLINE Selected(D d, hn::Mask<D> mask) : mask_(mask) {
    if constexpr (kCompress) {
      count_ = hn::CountTrue(d, mask);
    } else {
      std::uint8_t bits[8];
      hn::StoreMaskBits(d, mask, bits);
      count_ = static_cast<std::size_t>(std::popcount(bits[0]));
      const hn::RebindToUnsigned<D> du;
      const hn::Rebind<std::uint8_t, decltype(du)> bytes;
      order_ = hn::PromoteTo(du, hn::LoadU(bytes, kSetBits[bits[0]].data()));
    }
  }
  [[nodiscard]] HWY_INLINE std::size_t count() const { return count_; }

  // Stores the selected lanes of `v`, numbers of 32 bits. Writes a whole vector.
  template <class E, typename T>
  HWY_INLINE void Store(E e, hn::Vec<E> v, T* HWY_RESTRICT out) const {
    if constexpr (kCompress) {
      hn::StoreU(hn::Compress(v, hn::RebindMask(e, mask_)), e, out);
    } else {
      hn::StoreU(hn::TableLookupLanes(v, hn::IndicesFromVec(e, order_)), e, out);
    }
  }

 private:
  hn::Mask<D> mask_;
  hn::Vec<hn::RebindToUnsigned<D>> order_;
  std::size_t count_;
};

// Stores the selected ids side by side and returns their number. Writes a whole vector.
template <class D>
HWY_INLINE std::size_t StoreSelected(D d, hn::Mask<D> selected,
                                     hn::Vec<hn::RebindToUnsigned<D>> names,
                                     std::uint32_t* HWY_RESTRICT out) {
  const Selected<D> lanes(d, selected);
  lanes.Store(hn::RebindToUnsigned<D>(), names, out);
  return lanes.count();
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
