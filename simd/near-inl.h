// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_NEAR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_NEAR_INL_H
#undef IST_SIMD_NEAR_INL_H
#else
#define IST_SIMD_NEAR_INL_H
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstdint>

#include "ist/query/exact/triangle_bounds.h"

// Vector twin of find_near_scalar.
HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A node has few triangles: wider vectors would be emptier.
using NearTag = hn::CappedTag<float, 8>;
using NearVec = hn::Vec<NearTag>;

// The distance of one triangle's corners from the other's slab, above or below it.
HWY_INLINE NearVec ApartAlong(const NearVec (&normal)[3], NearVec bottom, NearVec top,
                              const NearVec (&corner)[3][3], NearVec slack) {
  const auto height = [&](const NearVec(&p)[3]) {
    return hn::Add(hn::Add(hn::Mul(normal[0], p[0]), hn::Mul(normal[1], p[1])),
                   hn::Mul(normal[2], p[2]));
  };
  const NearVec a = height(corner[0]), b = height(corner[1]), c = height(corner[2]);
  const NearVec lowest = hn::Min(hn::Min(a, b), c), highest = hn::Max(hn::Max(a, b), c);
  return hn::Sub(hn::Max(hn::Sub(lowest, top), hn::Sub(bottom, highest)), slack);
}

// The bounds of one triangle, or of several side by side, as vectors.
struct NearBounds {
  NearVec low[3], high[3], corner[3][3], normal[3], bottom, top, slack;

  template <class Read>
  explicit HWY_INLINE NearBounds(Read read) {
    std::size_t at = 0;
    for (auto& v : low) v = read(at++);
    for (auto& v : high) v = read(at++);
    for (auto& p : corner) {
      for (auto& v : p) v = read(at++);
    }
    for (auto& v : normal) v = read(at++);
    bottom = read(at++);
    top = read(at++);
    slack = read(at++);
  }
};

inline std::size_t FindNear(const TriangleLanes& lanes, const TriangleBounds* bounds,
                            const std::uint32_t* ids, std::size_t count, float distance,
                            NearPair* HWY_RESTRICT out) {
  const NearTag d;
  const NearVec far = hn::Set(d, distance);
  std::size_t found = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const float* numbers = bounds[ids[k]].box.low;
    const NearBounds b([&](std::size_t i) { return hn::Set(d, numbers[i]); });
    for (std::uint32_t first = 0; first < lanes.count;
         first += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const NearBounds a([&](std::size_t i) { return hn::Load(d, lanes.number[i] + first); });
      NearVec apart = ApartAlong(a.normal, a.bottom, a.top, b.corner, b.slack);
      apart = hn::Max(apart, ApartAlong(b.normal, b.bottom, b.top, a.corner, a.slack));
      for (std::size_t i = 0; i < 3; ++i) {
        apart = hn::Max(apart, hn::Sub(a.low[i], b.high[i]));
        apart = hn::Max(apart, hn::Sub(b.low[i], a.high[i]));
      }
      const auto near = hn::AndNot(hn::Gt(apart, far), hn::FirstN(d, lanes.count - first));
      std::uint8_t bits[8];
      hn::StoreMaskBits(d, near, bits);
      for (unsigned left = bits[0]; left != 0; left &= left - 1) {
        out[found++] = {first + static_cast<std::uint32_t>(std::countr_zero(left)), ids[k]};
      }
    }
  }
  return found;
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
