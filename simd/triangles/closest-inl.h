// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_TRIANGLES_CLOSEST_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_TRIANGLES_CLOSEST_INL_H
#undef IST_SIMD_TRIANGLES_CLOSEST_INL_H
#else
#define IST_SIMD_TRIANGLES_CLOSEST_INL_H
#endif

#include <hwy/highway.h>

#include "simd/triangles/closest.h"

// The vector form of ClosestFound: the same operations in the same order, none fused.
HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DoubleTag = hn::CappedTag<double, TriangleOctet::kSize>;
using DoubleVec = hn::Vec<DoubleTag>;
using DoubleMask = hn::Mask<DoubleTag>;

struct DoublePoints {
  DoubleVec x, y, z;
};
HWY_INLINE DoublePoints Difference(const DoublePoints& a, const DoublePoints& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE DoubleVec Dot(const DoublePoints& a, const DoublePoints& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE DoublePoints Cross(const DoublePoints& a, const DoublePoints& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

// Triangles with their edges and normals.
struct ClosestSides {
  DoublePoints corner[3], edge[3], normal;
  DoubleVec length[3], area;
  DoubleMask flat;

  HWY_INLINE void Measure() {
    for (std::size_t k = 0; k < 3; ++k) {
      edge[k] = Difference(corner[(k + 1) % 3], corner[k]);
      length[k] = Dot(edge[k], edge[k]);
    }
    normal = Cross(edge[0], Difference(corner[2], corner[0]));
    area = Dot(normal, normal);
    const DoubleVec parallel = hn::Set(DoubleTag(), kParallel * kParallel);
    flat = hn::Gt(area, hn::Mul(hn::Mul(parallel, length[0]), length[2]));
  }
};

// The closest parts so far.
class ClosestSoFar {
 public:
  HWY_INLINE ClosestSoFar()
      : square_(hn::Set(DoubleTag(), HUGE_VAL)), parts_(hn::Zero(DoubleTag())) {}

  HWY_INLINE void TakeFace(const DoublePoints& p, const ClosestSides& face, std::size_t number) {
    const DoubleTag d;
    DoubleVec least = hn::Set(d, HUGE_VAL);
    for (std::size_t k = 0; k < 3; ++k) {
      const DoubleVec side = Dot(Cross(face.edge[k], Difference(p, face.corner[k])), face.normal);
      least = hn::IfThenElse(hn::Lt(side, least), side, least);
    }
    const DoubleVec height = Dot(Difference(p, face.corner[0]), face.normal);
    const DoubleMask meets = hn::And(face.flat, hn::Ge(least, hn::Zero(d)));
    Take(meets, hn::Div(hn::Mul(height, height), face.area), number);
  }
  HWY_INLINE void TakeEdges(const ClosestSides& a, std::size_t i, const ClosestSides& b,
                            std::size_t j) {
    const DoubleTag d;
    const DoubleVec zero = hn::Zero(d), parallel = hn::Set(d, kParallel * kParallel);
    const DoublePoints &u = a.edge[i], &v = b.edge[j];
    const DoublePoints w = Difference(b.corner[j], a.corner[i]), n = Cross(u, v);
    const DoubleVec area = Dot(n, n);
    const DoubleVec s = Dot(Cross(w, v), n), t = Dot(Cross(w, u), n), height = Dot(w, n);
    const DoubleMask skew = hn::Gt(area, hn::Mul(hn::Mul(parallel, a.length[i]), b.length[j]));
    const DoubleMask on_first = hn::And(hn::Ge(s, zero), hn::Le(s, area));
    const DoubleMask on_second = hn::And(hn::Ge(t, zero), hn::Le(t, area));
    Take(hn::And(skew, hn::And(on_first, on_second)), hn::Div(hn::Mul(height, height), area),
         ClosestParts::kEdges + 3 * i + j);
  }
  HWY_INLINE void TakeEdge(const DoublePoints& p, const ClosestSides& t, std::size_t k,
                           std::size_t number) {
    const DoubleTag d;
    const DoubleVec zero = hn::Zero(d), one = hn::Set(d, 1.0);
    const DoublePoints from = Difference(p, t.corner[k]);
    const DoubleVec part = hn::Div(Dot(from, t.edge[k]), t.length[k]);
    const DoubleVec clamped =
        hn::IfThenElse(hn::Lt(part, zero), zero, hn::IfThenElse(hn::Lt(one, part), one, part));
    const DoubleVec by = hn::IfThenElseZero(hn::Gt(t.length[k], zero), clamped);
    const DoublePoints& edge = t.edge[k];
    const DoublePoints way = {hn::Sub(from.x, hn::Mul(by, edge.x)),
                              hn::Sub(from.y, hn::Mul(by, edge.y)),
                              hn::Sub(from.z, hn::Mul(by, edge.z))};
    Take(hn::FirstN(d, TriangleOctet::kSize), Dot(way, way), number);
  }
  HWY_INLINE void Store(double* HWY_RESTRICT square, double* HWY_RESTRICT parts) const {
    hn::Store(square_, DoubleTag(), square);
    hn::Store(parts_, DoubleTag(), parts);
  }

 private:
  HWY_INLINE void Take(DoubleMask valid, DoubleVec square, std::size_t number) {
    const DoubleMask better = hn::And(valid, hn::Lt(square, square_));
    square_ = hn::IfThenElse(better, square, square_);
    parts_ = hn::IfThenElse(better, hn::Set(DoubleTag(), static_cast<double>(number)), parts_);
  }

  DoubleVec square_, parts_;
};

HWY_INLINE DoublePoints LoadCorner(const double (&from)[3][TriangleOctet::kSize],
                                   std::size_t lane) {
  const DoubleTag d;
  return {hn::Load(d, from[0] + lane), hn::Load(d, from[1] + lane), hn::Load(d, from[2] + lane)};
}

// Moves points as PlainMove does.
HWY_INLINE DoublePoints Moved(const DoublePoints& p, const PlainMove& move) {
  const DoubleTag d;
  const auto row = [&](std::size_t i) HWY_ATTR {
    const auto& r = move.rotation[i];
    const DoubleVec xy = hn::Add(hn::Mul(hn::Set(d, r[0]), p.x), hn::Mul(hn::Set(d, r[1]), p.y));
    return hn::Add(hn::Add(xy, hn::Mul(hn::Set(d, r[2]), p.z)), hn::Set(d, move.translation[i]));
  };
  return {row(0), row(1), row(2)};
}

inline void ClosestOctet(const TriangleOctet& pairs, const PlainMove& move, OctetDistances& out) {
  using Parts = ClosestParts;
  for (std::size_t lane = 0; lane < TriangleOctet::kSize; lane += hn::Lanes(DoubleTag())) {
    ClosestSides a, b;
    for (std::size_t k = 0; k < 3; ++k) {
      a.corner[k] = LoadCorner(pairs.fixed[k], lane);
      b.corner[k] = Moved(LoadCorner(pairs.moving[k], lane), move);
    }
    a.Measure();
    b.Measure();
    ClosestSoFar closest;
    for (std::size_t k = 0; k < 3; ++k) {
      closest.TakeFace(a.corner[k], b, Parts::kCornerToFace + k);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      closest.TakeFace(b.corner[k], a, Parts::kFaceToCorner + k);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) closest.TakeEdges(a, i, b, j);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        closest.TakeEdge(a.corner[i], b, j, Parts::kCornerToEdge + 3 * i + j);
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        closest.TakeEdge(b.corner[j], a, i, Parts::kEdgeToCorner + 3 * i + j);
      }
    }
    closest.Store(out.square + lane, out.parts + lane);
  }
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
