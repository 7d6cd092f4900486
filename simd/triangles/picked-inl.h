// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_EXACT_PICKED_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_EXACT_PICKED_INL_H
#undef IST_SIMD_EXACT_PICKED_INL_H
#else
#define IST_SIMD_EXACT_PICKED_INL_H
#endif

#include <hwy/highway.h>

#include "simd/triangles/clusters-inl.h"
#include "simd/triangles/triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The lanes of some listed pairs of a ClusterPair: their triangles, and their indices.
class PickedPairs {
 public:
  HWY_INLINE PickedPairs(const ClusterPair& pair, std::size_t at)
      : fixed_(Fixed(pair, at)), moving_(Moving(pair, at)) {}

  [[nodiscard]] HWY_INLINE Triangles FixedOf(const ClusterPair& pair) const {
    return Picked(fixed_, pair.still());
  }
  [[nodiscard]] HWY_INLINE Triangles MovingOf(const ClusterPair& pair) const {
    return Picked(moving_, pair.moved());
  }
  [[nodiscard]] HWY_INLINE IndexVec FixedIds(const ClusterPair& pair) const {
    return fixed_(pair.fixed_ids());
  }
  [[nodiscard]] HWY_INLINE IndexVec MovingIds(const ClusterPair& pair) const {
    return moving_(pair.moving_ids());
  }

 private:
  static HWY_INLINE IndexVec Fixed(const ClusterPair& pair, std::size_t at) {
    const IndexTag du;
    return hn::And(hn::LoadU(du, pair.codes() + at), hn::Set(du, 15U));
  }
  static HWY_INLINE IndexVec Moving(const ClusterPair& pair, std::size_t at) {
    const IndexTag du;
    return hn::And(hn::ShiftRight<4>(hn::LoadU(du, pair.codes() + at)), hn::Set(du, 15U));
  }
  static HWY_INLINE Triangles Picked(const Pick& pick, const SixteenTriangles& from) {
    Triangles t;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& p = from.corner[k];
      t.corner[k] = {pick(p[0]), pick(p[1]), pick(p[2])};
    }
    return t;
  }

  Pick fixed_, moving_;
};

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
