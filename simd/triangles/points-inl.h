// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_EXACT_POINTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_EXACT_POINTS_INL_H
#undef IST_SIMD_EXACT_POINTS_INL_H
#else
#define IST_SIMD_EXACT_POINTS_INL_H
#endif

#include <hwy/highway.h>

#include "simd/triangles/cluster_step.h"
#include "simd/triangles/nodes-inl.h"
#include "simd/triangles/triangle_lanes.h"
#include "simd/triangles/triangles-inl.h"

// Vector twins of the scalar forms in simd/triangles/clusters_scalar.cpp.
HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// No product is fused to a sum.
inline std::uint32_t NearNodes(const NodeBlock& nodes, const TreePoint& point, float far,
                               float* squares) {
  const Sixteen zero = Set16(0), rounding = Set16(kPointRounding), error = Set16(point.error);
  Sixteen v[3];
  for (std::size_t i = 0; i < 3; ++i) {
    v[i] = (Set16(point.at[i]) - Load16(nodes.centre[i])) + Set16(point.rest[i]);
  }
  const Sixteen size = (Abs(v[0]) + Abs(v[1])) + Abs(v[2]);
  const Sixteen slack = error + rounding * (size + Load16(nodes.radius));
  Sixteen gap[3];
  for (std::size_t i = 0; i < 3; ++i) {
    gap[i] = Max((Abs(v[i]) - Load16(nodes.half[i])) - slack, zero);
  }
  const Sixteen normal[3] = {Load16(nodes.normal[0]), Load16(nodes.normal[1]),
                             Load16(nodes.normal[2])};
  const Sixteen along = Dot(normal, v), square = Dot(v, v);
  const Sixteen above =
      Max((Abs(along - Load16(nodes.offset)) - Load16(nodes.thickness)) - slack, zero);
  const Sixteen across = (square - along * along) - Set16(2 * kPointRounding) * square;
  const Sixteen beside = Max((Sqrt(Max(across, zero)) - Load16(nodes.rim)) - slack, zero);
  const Sixteen least = Max(Dot(gap, gap), above * above + beside * beside);
  const Sixteen out = least * Set16(1 - kPointRounding);
  for (std::size_t k = 0; k < kParts; ++k) {
    hn::StoreU(out.part[k], FloatTag(), squares + k * kLanes);
  }
  return ~BitsOf(out > Set16(far)) & kAllLanes;
}

// Bounds of the squares of distances.
struct SquareBounds {
  FloatVec least, most;
};

HWY_INLINE SquareBounds BoundTriangles(const Triangles& t, const Points& p, FloatVec error) {
  const FloatTag d;
  const FloatVec zero = hn::Zero(d), one = hn::Set(d, 1.0F), tiny = hn::Set(d, kLeastSquare);
  const Points from[3] = {p - t.corner[0], p - t.corner[1], p - t.corner[2]};
  const Points edge[3] = {t.corner[1] - t.corner[0], t.corner[2] - t.corner[1],
                          t.corner[0] - t.corner[2]};
  const FloatVec lengths[3] = {FusedDot(edge[0], edge[0]), FusedDot(edge[1], edge[1]),
                               FusedDot(edge[2], edge[2])};
  Points way{zero, zero, zero};
  FloatVec square = hn::Set(d, std::numeric_limits<float>::infinity());
  const auto take = [&](hn::Mask<FloatTag> these, const Points& here, FloatVec squared) HWY_ATTR {
    way = {hn::IfThenElse(these, here.x, way.x), hn::IfThenElse(these, here.y, way.y),
           hn::IfThenElse(these, here.z, way.z)};
    square = hn::IfThenElse(these, squared, square);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const FloatVec along = hn::Div(FusedDot(from[i], edge[i]), hn::Max(lengths[i], tiny));
    const FloatVec part = hn::Min(hn::Max(along, zero), one);
    const Points here = {hn::NegMulAdd(part, edge[i].x, from[i].x),
                         hn::NegMulAdd(part, edge[i].y, from[i].y),
                         hn::NegMulAdd(part, edge[i].z, from[i].z)};
    const FloatVec squared = FusedDot(here, here);
    take(hn::Lt(squared, square), here, squared);
  }
  const Points normal = FusedCross(edge[0], edge[1]);
  const FloatVec area = FusedDot(normal, normal);
  FloatVec side = FusedDot(FusedCross(edge[0], from[0]), normal);
  for (std::size_t i = 1; i < 3; ++i) {
    side = hn::Min(side, FusedDot(FusedCross(edge[i], from[i]), normal));
  }
  const FloatVec sharpest =
      hn::Max(hn::Max(hn::Mul(lengths[0], lengths[1]), hn::Mul(lengths[1], lengths[2])),
              hn::Mul(lengths[2], lengths[0]));
  const FloatVec least_area = hn::Max(hn::Mul(sharpest, hn::Set(d, kPlaneSine)), tiny);
  const auto plane = hn::And(hn::Gt(side, zero), hn::Gt(area, least_area));
  const FloatVec height = hn::Div(FusedDot(from[0], normal), area);
  const Points foot = {hn::Mul(height, normal.x), hn::Mul(height, normal.y),
                       hn::Mul(height, normal.z)};
  take(plane, foot, FusedDot(foot, foot));
  const FloatVec first =
      hn::Min(hn::Min(FusedDot(way, from[0]), FusedDot(way, from[1])), FusedDot(way, from[2]));
  const FloatVec least = hn::Sub(hn::Div(first, hn::Sqrt(hn::Max(square, tiny))), error);
  const FloatVec more = hn::IfThenElse(plane, hn::Mul(error, hn::Set(d, kPlaneError)), error);
  const FloatVec most = hn::Add(hn::Sqrt(square), more);
  return {hn::IfThenElseZero(hn::Gt(least, zero),
                             hn::Mul(hn::Mul(least, least), hn::Set(d, 1 - kPointRounding))),
          hn::Mul(hn::Mul(most, most), hn::Set(d, 1 + kPointRounding))};
}

inline std::uint32_t NearTriangles(const TriangleCluster& cluster, const ClusterPoint& point,
                                   float& far, float* squares) {
  const FloatTag d;
  const float unit_back = 1 / point.unit;
  const FloatVec unit = hn::Set(d, point.unit), back = hn::Set(d, unit_back * unit_back);
  const FloatVec error = hn::Set(d, point.error * point.unit);
  const Points p = {hn::Set(d, point.at[0] * point.unit), hn::Set(d, point.at[1] * point.unit),
                    hn::Set(d, point.at[2] * point.unit)};
  Sixteen least;
  FloatVec most = hn::Set(d, far);
  for (std::size_t k = 0; k < kParts; ++k) {
    const std::size_t at = k * kLanes;
    Triangles t;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto& from = cluster.corner[corner];
      t.corner[corner] = {hn::Mul(hn::Load(d, from[0] + at), unit),
                          hn::Mul(hn::Load(d, from[1] + at), unit),
                          hn::Mul(hn::Load(d, from[2] + at), unit)};
    }
    const SquareBounds bounds = BoundTriangles(t, p, error);
    least.part[k] = hn::Mul(bounds.least, back);
    const FloatVec farthest = hn::Add(hn::Mul(bounds.most, back), hn::Set(d, kSquareUnderflow));
    most = hn::IfThenElse(hn::Lt(farthest, most), farthest, most);
    hn::StoreU(least.part[k], d, squares + at);
  }
  far = hn::GetLane(hn::MinOfLanes(d, most));
  return ~BitsOf(least > Set16(far)) & kAllLanes;
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
