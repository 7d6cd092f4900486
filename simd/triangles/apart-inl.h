// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_EXACT_APART_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_EXACT_APART_INL_H
#undef IST_SIMD_EXACT_APART_INL_H
#else
#define IST_SIMD_EXACT_APART_INL_H
#endif

#include <hwy/highway.h>

#include "simd/triangles/triangle_lanes.h"
#include "simd/triangles/triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The corner of each triangle that lies least far along v, and how far.
struct Lowest {
  Points corner;
  FloatVec along;

  HWY_INLINE Lowest(const Triangles& t, const Points& v)
      : corner(t.corner[0]), along(FusedDot(t.corner[0], v)) {
    for (std::size_t k = 1; k < 3; ++k) {
      const FloatVec at = FusedDot(t.corner[k], v);
      corner = Chosen(hn::Lt(at, along), t.corner[k], corner);
      along = hn::Min(along, at);
    }
  }
};

HWY_INLINE Points Middle(const Triangles& t) {
  const FloatVec third = hn::Set(FloatTag(), 1.0F / 3);
  const auto mean = [&](FloatVec a, FloatVec b, FloatVec c) {
    return hn::Mul(hn::Add(hn::Add(a, b), c), third);
  };
  const auto& [p, q, r] = t.corner;
  return {mean(p.x, q.x, r.x), mean(p.y, q.y, r.y), mean(p.z, q.z, r.z)};
}

// The squares of a distance that pairs of triangles have at least, and of one that they have at
// most, but for the rounding of coordinates: four times `error` of the latter.
struct Bounds {
  FloatVec least, most;
};

// Bounds distances. Whatever vector v is, the triangles are no nearer than the gap between them
// along v, and the rounding of that gap is at most twice `error` for each unit of |v|₁, however
// thin a triangle is. Each look takes the vector between the nearest points so far, whose length
// is no less than the distance. Ends early where all `wanted` pairs are farther than `far` says, a
// square.
//
// Source: E. G. Gilbert, An iterative procedure for computing the minimum of a quadratic form on a
// convex set, SIAM Journal on Control 4, 1966.
HWY_INLINE Bounds DistanceBounds(const Triangles& fixed, const Triangles& moving, FloatVec error,
                                 hn::Mask<FloatTag> wanted, FloatVec far) {
  const FloatTag d;
  const FloatVec zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  const FloatVec slack = hn::Add(error, error);
  Points v = Middle(moving) - Middle(fixed);
  FloatVec length = FusedDot(v, v);
  Bounds bounds{zero, length};
  for (int look = 0; look < kLooks; ++look) {
    const Points back = {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)};
    const Lowest b(moving, v), a(fixed, back);
    const FloatVec gap = hn::NegMulAdd(slack, Size(v), hn::Add(b.along, a.along));
    // A gap is of the dimension of a square: so its own square may overflow.
    const FloatVec square = hn::Mul(gap, hn::Div(gap, length));
    const auto known = hn::And(hn::Gt(gap, zero), hn::Gt(length, hn::Set(d, kLeastSquare)));
    bounds.least = hn::Max(bounds.least, hn::IfThenElseZero(known, square));
    if (hn::AllFalse(d, hn::AndNot(hn::Gt(bounds.least, far), wanted))) break;
    const Points step = (b.corner - a.corner) - v;
    const FloatVec squared = FusedDot(step, step);
    const FloatVec part = hn::Div(hn::Neg(FusedDot(v, step)), squared);
    const FloatVec by = hn::Min(hn::Max(part, zero), one);
    const FloatVec go = hn::IfThenElseZero(hn::Gt(squared, zero), by);
    v = {hn::MulAdd(go, step.x, v.x), hn::MulAdd(go, step.y, v.y), hn::MulAdd(go, step.z, v.z)};
    length = FusedDot(v, v);
    bounds.most = hn::Min(bounds.most, length);
  }
  bounds.least = hn::Mul(bounds.least, hn::Set(d, 1 - 0x1p-20F));
  return bounds;
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
