// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_MEASURE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_MEASURE_INL_H
#undef IST_SIMD_MEASURE_INL_H
#else
#define IST_SIMD_MEASURE_INL_H
#endif

#include <hwy/highway.h>

#include "simd/bounds-inl.h"
#include "simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Measures as ist::PairTest does. Few pairs improve a bound, so a root is taken only where squares,
// with some last bits to spare, say that one may.
template <bool kSlabs>
class Measurer {
 public:
  using V = hn::Vec<Full>;

  // `most_radii` is at least every sum of radii.
  HWY_INLINE Measurer(DistanceBounds& bounds, float most_radii)
      : bounds_(bounds), most_radii_(most_radii) {
    Spare();
  }

  // `here` are the lanes in use, `ends` those of pairs that are not descended.
  HWY_INLINE void Both(const VectorTest<kSlabs>& test, hn::Mask<Full> here, hn::Mask<Full> ends) {
    auto improves = hn::And(ends, Below(test, hn::Add(lower_, test.radius_sum)));
    if constexpr (kSlabs) {
      improves = hn::AndNot(hn::Ge(hn::Sub(test.over_fixed, test.fixed_sum), lower_), improves);
      improves =
          hn::AndNot(hn::Ge(hn::Sub(test.over_moving, test.moving_sum), scaled_lower_), improves);
    }
    improves = hn::Or(improves, ImprovesUpper(test, here));
    if (HWY_LIKELY(hn::AllFalse(Full(), improves))) return;
    const V distance = hn::Sqrt(test.squared);
    Least(bounds_.lower, ends, test.Apart(distance));
    Least(bounds_.upper, here, hn::Add(distance, test.radius_sum));
    Spare();
  }
  HWY_INLINE void Upper(const VectorTest<kSlabs>& test, hn::Mask<Full> overlapping) {
    if (HWY_LIKELY(hn::AllFalse(Full(), ImprovesUpper(test, overlapping)))) return;
    Least(bounds_.upper, overlapping, hn::Add(hn::Sqrt(test.squared), test.radius_sum));
    Spare();
  }

 private:
  HWY_INLINE static hn::Mask<Full> Below(const VectorTest<kSlabs>& test, V length) {
    const V positive = hn::Max(length, hn::Zero(Full()));
    return hn::Lt(test.squared, hn::Mul(positive, positive));
  }
  HWY_INLINE hn::Mask<Full> ImprovesUpper(const VectorTest<kSlabs>& test,
                                          hn::Mask<Full> among) const {
    return hn::And(among, Below(test, hn::Sub(upper_, test.radius_sum)));
  }
  HWY_INLINE void Spare() {
    const float spare = 0x1p-20F;
    scaled_lower_ = hn::Set(Full(), kSlabScale * bounds_.lower);
    lower_ = hn::Set(Full(), bounds_.lower + spare * (most_radii_ + HWY_MAX(bounds_.lower, 0.0F)));
    upper_ = hn::Set(Full(), bounds_.upper + spare * (most_radii_ + bounds_.upper));
  }
  HWY_INLINE static void Least(float& so_far, hn::Mask<Full> among, V v) {
    const Full d;
    const V none = hn::Set(d, DistanceBounds::kNone);
    const V numbers = hn::IfThenElse(hn::And(among, hn::Lt(v, none)), v, none);
    so_far = HWY_MIN(so_far, hn::GetLane(hn::MinOfLanes(d, numbers)));
  }

  DistanceBounds& bounds_;
  float most_radii_;
  V lower_, scaled_lower_, upper_;
};

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
