#include "simd/triangles/cluster_step.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/triangles/cluster_vector.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <limits>

#include "simd/triangles/balls-inl.h"
#include "simd/triangles/closest-inl.h"
#include "simd/triangles/clusters-inl.h"
#include "simd/triangles/nodes-inl.h"
#include "simd/triangles/points-inl.h"
#include "simd/triangles/triangle_lanes.h"
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

HWY_INLINE void Append(hn::Mask<FloatTag> mask, IndexVec fixed, IndexVec moving,
                       TriangleList& out) {
  const IndexTag du;
  const Selected<FloatTag> selected(FloatTag(), mask);
  selected.Store(du, fixed, out.fixed + out.count);
  selected.Store(du, moving, out.moving + out.count);
  out.count += selected.count();
}

HWY_INLINE Triangles LoadTriangles(const float (&from)[3][3][TriangleBatch::kRoom],
                                   std::size_t at) {
  const FloatTag d;
  Triangles t;
  for (std::size_t k = 0; k < 3; ++k) {
    t.corner[k] = {hn::LoadU(d, from[k][0] + at), hn::LoadU(d, from[k][1] + at),
                   hn::LoadU(d, from[k][2] + at)};
  }
  return t;
}

void DecideTriangles(TriangleBatch& batch, FoundTriangles& out) {
  const FloatTag d;
  const IndexTag du;
  for (std::size_t i = 0; i < batch.count; i += kLanes) {
    const auto there = hn::FirstN(d, batch.count - i);
    const Decision decision = Decide(LoadTriangles(batch.fixed, i), LoadTriangles(batch.moving, i),
                                     hn::LoadU(d, batch.error + i));
    const IndexVec fixed = hn::LoadU(du, batch.fixed_id + i);
    const IndexVec moving = hn::LoadU(du, batch.moving_id + i);
    const auto certain = hn::And(there, decision.meet), open = hn::And(there, decision.open);
    Append(certain, fixed, moving, out.certain);
    if (!hn::AllFalse(d, open)) Append(open, fixed, moving, out.open);
  }
  batch.count = 0;
}

// Moves those pairs to the batch that neither triangle's plane tells apart.
HWY_INLINE void MoveToBatch(const ClusterPair& pair, std::size_t count, TriangleBatch& batch,
                            FoundTriangles& out) {
  const FloatTag d;
  const IndexTag du;
  const FloatVec error = hn::Set(d, pair.error());
  for (std::size_t n = 0; n < count; n += kLanes) {
    const PickedPairs picked(pair, n);
    const Triangles fixed = picked.FixedOf(pair), moving = picked.MovingOf(pair);
    const BothSides sides = SidesOf(fixed, moving, error);
    const auto apart = hn::Or(OneSided(sides.of_moving), OneSided(sides.of_fixed));
    const Selected<FloatTag> left(d, hn::AndNot(apart, hn::FirstN(d, count - n)));
    if (batch.count > TriangleBatch::kSize - kLanes) DecideTriangles(batch, out);
    const std::size_t to = batch.count;
    const auto store = [&](const Points& p, float(&at)[3][TriangleBatch::kRoom]) {
      left.Store(d, p.x, at[0] + to);
      left.Store(d, p.y, at[1] + to);
      left.Store(d, p.z, at[2] + to);
    };
    for (std::size_t k = 0; k < 3; ++k) {
      store(fixed.corner[k], batch.fixed[k]);
      store(moving.corner[k], batch.moving[k]);
    }
    left.Store(du, picked.FixedIds(pair), batch.fixed_id + to);
    left.Store(du, picked.MovingIds(pair), batch.moving_id + to);
    hn::StoreU(error, d, batch.error + to);
    batch.count += left.count();
  }
}

// Keeps the pairs that may be within reach, and lowers that. A vector is looked at no longer than
// some pair in it may be kept: bounds.least is rounded down by 2⁻²⁰ at last.
HWY_INLINE void KeepNear(const ClusterPair& pair, std::size_t count, Reach& reach,
                         FoundTriangles& out) {
  const FloatTag d;
  const FloatVec infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  for (std::size_t n = 0; n < count; n += kLanes) {
    const PickedPairs picked(pair, n);
    const auto there = hn::FirstN(d, count - n);
    const float enough = (reach.triangles * reach.triangles) * (1 + 0x1p-18F);
    const Bounds bounds = DistanceBounds(picked.FixedOf(pair), picked.MovingOf(pair),
                                         hn::Set(d, pair.error()), there, hn::Set(d, enough));
    const FloatVec most = hn::IfThenElse(there, bounds.most, infinite);
    reach.triangles =
        HWY_MIN(reach.triangles,
                nearest_of(hn::GetLane(hn::MinOfLanes(d, most)), pair.error()) + reach.margin);
    const FloatVec far = hn::Set(d, reach.triangles * reach.triangles);
    const auto near = hn::AndNot(hn::Gt(bounds.least, far), there);
    if (hn::AllFalse(d, near)) continue;
    Selected<FloatTag>(d, near).Store(d, bounds.least, out.squares + out.open.count);
    Append(near, picked.FixedIds(pair), picked.MovingIds(pair), out.open);
  }
}

// Calls `take(pair, count)` for pairs of clusters, with the number of their pairs of triangles
// within reach.
template <bool kFourth, class Take>
HWY_INLINE std::size_t EachPair(const ClusterStep& step, const ClusterPairs& clusters,
                                const float& reach, TriangleBatch& batch, const FoundTriangles& out,
                                Take take) {
  const LaneNodes& pairs = clusters.pairs;
  const std::uint32_t last = (step.moving_triangles - 1) / kClusterWidth;
  std::size_t k = 0;
  while (k < pairs.count && out.has_room()) {
    const std::uint32_t lane = pairs.lane(k);
    ClusterPair pair(step, clusters.lanes, lane, clusters.moving + lane, batch.codes);
    load_ahead(step.moving[HWY_MIN(clusters.moving + lane + 1, last)]);
    for (; k < pairs.count && pairs.lane(k) == lane && out.has_room(); ++k) {
      const std::uint32_t fixed = pairs.node(k);
      load_ahead(step.fixed[pairs.node(HWY_MIN(k + kItemsAhead, pairs.count - 1))]);
      const NodeBlock& block = step.fixed_nodes.blocks[fixed / kClusterWidth];
      take(pair, pair.Find<kFourth>(fixed, block, fixed % kClusterWidth, reach));
    }
  }
  return k;
}

std::size_t MeetClusters(const ClusterStep& step, const ClusterPairs& pairs, TriangleBatch& batch,
                         FoundTriangles& out) {
  return EachPair<false>(step, pairs, 0.0F, batch, out,
                         [&](const ClusterPair& pair, std::size_t count)
                             HWY_ATTR { MoveToBatch(pair, count, batch, out); });
}

std::size_t NearClusters(const ClusterStep& step, const ClusterPairs& pairs, Reach& reach,
                         TriangleBatch& batch, FoundTriangles& out) {
  return EachPair<true>(step, pairs, reach.triangles, batch, out,
                        [&](const ClusterPair& pair, std::size_t count)
                            HWY_ATTR { KeepNear(pair, count, reach, out); });
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ist::simd {

#define IST_CLUSTER_KERNELS(TARGET)                                              \
  ClusterKernels {                                                               \
    HWY_CHOOSE_##TARGET(TurnNodes), HWY_CHOOSE_##TARGET(MeetNodes),              \
        HWY_CHOOSE_##TARGET(ListLanes), HWY_CHOOSE_##TARGET(MeetChildren),       \
        HWY_CHOOSE_##TARGET(ScoreChildren), HWY_CHOOSE_##TARGET(MeetClusters),   \
        HWY_CHOOSE_##TARGET(DecideTriangles), HWY_CHOOSE_##TARGET(NearClusters), \
        HWY_CHOOSE_##TARGET(NearNodes), HWY_CHOOSE_##TARGET(NearTriangles),      \
        HWY_CHOOSE_##TARGET(ClosestOctet), HWY_CHOOSE_##TARGET(BoundNodes),      \
        HWY_CHOOSE_##TARGET(BoundCorners), HWY_CHOOSE_##TARGET(BoundAround)      \
  }

ClusterKernels cluster_kernels(std::int64_t target) {
  switch (target) {
    case HWY_AVX3:
      return IST_CLUSTER_KERNELS(AVX3);
    case HWY_AVX2:
      return IST_CLUSTER_KERNELS(AVX2);
    case HWY_SSE4:
      return IST_CLUSTER_KERNELS(SSE4);
    case HWY_SSSE3:
      return IST_CLUSTER_KERNELS(SSSE3);
    default:
      return IST_CLUSTER_KERNELS(NEON);
  }
}

#undef IST_CLUSTER_KERNELS

}  // namespace ist::simd
#endif
