// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_EXACT_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_EXACT_TRIANGLES_INL_H
#undef IST_SIMD_EXACT_TRIANGLES_INL_H
#else
#define IST_SIMD_EXACT_TRIANGLES_INL_H
#endif

#include <hwy/highway.h>

#include "simd/triangles/cluster_step.h"
#include "simd/triangles/sixteen-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A vector of points or of differences.
struct Points {
  FloatVec x, y, z;
};
HWY_INLINE Points operator-(const Points& a, const Points& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE FloatVec FusedDot(const Points& a, const Points& b) {
  return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}
HWY_INLINE Points FusedCross(const Points& a, const Points& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
// The sum of the absolute coordinates.
HWY_INLINE FloatVec Size(const Points& a) {
  return hn::Add(hn::Add(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z));
}

struct Triangles {
  Points corner[3];
};

// A determinant of three differences, each of whose coordinates is wrong by at most `error`, is
// wrong by no more than this, where x, y and z are the sums of their absolute coordinates, and
// twice the error more (docs/guarantees.md, Triangles decided in float).
HWY_INLINE FloatVec DeterminantError(FloatVec x, FloatVec y, FloatVec z, FloatVec error) {
  const FloatTag d;
  const FloatVec xy = hn::Mul(x, y);
  const FloatVec sides = hn::MulAdd(hn::Add(x, y), z, xy);
  const FloatVec rounding =
      hn::MulAdd(hn::Mul(xy, z), hn::Set(d, kDeterminantRounding), hn::Set(d, kUnderflow));
  return hn::MulAdd(sides, error, rounding);
}

// On which side of one triangle's plane the other's corners lie, with the error of all three.
struct Sides {
  FloatVec of[3], error;
};

// The sides of both planes of pairs of triangles.
struct BothSides {
  Sides of_moving, of_fixed;  // corners, on sides of the other's plane
};

HWY_INLINE BothSides SidesOf(const Triangles& fixed, const Triangles& moving, FloatVec error) {
  const Points u = fixed.corner[1] - fixed.corner[0], v = fixed.corner[2] - fixed.corner[0];
  const Points s = moving.corner[1] - moving.corner[0], t = moving.corner[2] - moving.corner[0];
  const Points w = moving.corner[0] - fixed.corner[0];
  const FloatVec more = hn::Add(error, error);
  const FloatVec u1 = hn::Add(Size(u), more), v1 = hn::Add(Size(v), more);
  const FloatVec s1 = hn::Add(Size(s), more), t1 = hn::Add(Size(t), more), w1 = Size(w);
  BothSides sides;
  const Points n = FusedCross(u, v), m = FusedCross(s, t);
  auto& of_moving = sides.of_moving;
  of_moving.of[0] = FusedDot(n, w);
  of_moving.of[1] = hn::Add(of_moving.of[0], FusedDot(n, s));
  of_moving.of[2] = hn::Add(of_moving.of[0], FusedDot(n, t));
  of_moving.error = DeterminantError(u1, v1, hn::Add(w1, hn::Max(s1, t1)), error);
  auto& of_fixed = sides.of_fixed;
  of_fixed.of[0] = hn::Neg(FusedDot(m, w));
  of_fixed.of[1] = hn::Add(of_fixed.of[0], FusedDot(m, u));
  of_fixed.of[2] = hn::Add(of_fixed.of[0], FusedDot(m, v));
  of_fixed.error = DeterminantError(s1, t1, hn::Add(w1, hn::Max(u1, v1)), error);
  return sides;
}

// Where all three are certainly on one side.
HWY_INLINE hn::Mask<FloatTag> OneSided(const Sides& sides) {
  const FloatVec least = hn::Min(hn::Min(sides.of[0], sides.of[1]), sides.of[2]);
  const FloatVec most = hn::Max(hn::Max(sides.of[0], sides.of[1]), sides.of[2]);
  return hn::Or(hn::Gt(least, sides.error), hn::Gt(hn::Neg(most), sides.error));
}
// Where each is certainly on one or the other.
HWY_INLINE hn::Mask<FloatTag> Certain(const Sides& sides) {
  const FloatVec least =
      hn::Min(hn::Min(hn::Abs(sides.of[0]), hn::Abs(sides.of[1])), hn::Abs(sides.of[2]));
  return hn::Gt(least, sides.error);
}

HWY_INLINE Points Chosen(hn::Mask<FloatTag> mask, const Points& yes, const Points& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

// Turns the corners round until the first is the one that is alone on its side. Returns where that
// is the negative side.
HWY_INLINE hn::Mask<FloatTag> LoneFirst(const Sides& sides, Triangles& t) {
  const FloatTag d;
  const auto zero = hn::Zero(d);
  const auto s0 = hn::Lt(sides.of[0], zero), s1 = hn::Lt(sides.of[1], zero),
             s2 = hn::Lt(sides.of[2], zero);
  const auto third = hn::Not(hn::Xor(s0, s1));                      // 0 and 1 are together
  const auto second = hn::AndNot(third, hn::Not(hn::Xor(s0, s2)));  // 0 and 2 are
  const Triangles old = t;
  for (std::size_t k = 0; k < 3; ++k) {
    t.corner[k] = Chosen(third, old.corner[(k + 2) % 3],
                         Chosen(second, old.corner[(k + 1) % 3], old.corner[k]));
  }
  return hn::Or(hn::And(third, s2),
                hn::Or(hn::And(second, s1), hn::AndNot(hn::Or(third, second), s0)));
}

HWY_INLINE void SwapLast(hn::Mask<FloatTag> mask, Triangles& t) {
  const Points second = t.corner[1];
  t.corner[1] = Chosen(mask, t.corner[2], second);
  t.corner[2] = Chosen(mask, second, t.corner[2]);
}

// The pairs that are certain to meet, and those of which nothing is certain.
struct Decision {
  hn::Mask<FloatTag> meet, open;
};

// Source: O. Devillers and P. Guigue, Faster triangle-triangle intersection tests, INRIA, 2002.
HWY_INLINE Decision Decide(Triangles fixed, Triangles moving, FloatVec error) {
  const BothSides sides = SidesOf(fixed, moving, error);
  const auto apart = hn::Or(OneSided(sides.of_moving), OneSided(sides.of_fixed));
  const auto sure = hn::And(Certain(sides.of_moving), Certain(sides.of_fixed));
  const auto below_moving = LoneFirst(sides.of_fixed, fixed);
  const auto below_fixed = LoneFirst(sides.of_moving, moving);
  SwapLast(below_moving, moving);
  SwapLast(below_fixed, fixed);
  const Points w = moving.corner[0] - fixed.corner[0];
  const Points u = fixed.corner[1] - fixed.corner[0], v = fixed.corner[2] - fixed.corner[0];
  const Points s = moving.corner[1] - moving.corner[0], t = moving.corner[2] - moving.corner[0];
  const FloatVec more = hn::Add(error, error);
  const auto size = [&](const Points& p) HWY_ATTR { return hn::Add(Size(p), more); };
  const FloatVec w1 = size(w);
  // The lines in which the planes meet the triangles overlap where both are negative.
  const FloatVec first = FusedDot(FusedCross(u, w), s);
  const FloatVec first_error = DeterminantError(size(u), w1, size(s), error);
  const FloatVec last = FusedDot(FusedCross(w, v), t);
  const FloatVec last_error = DeterminantError(size(v), w1, size(t), error);
  const auto beside = hn::Or(hn::Gt(first, first_error), hn::Gt(last, last_error));
  const auto overlap =
      hn::And(hn::Gt(hn::Neg(first), first_error), hn::Gt(hn::Neg(last), last_error));
  const auto no = hn::Or(apart, hn::And(sure, beside));
  const auto yes = hn::And(sure, overlap);
  return {hn::AndNot(apart, yes), hn::Not(hn::Or(no, yes))};
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
