// Per-target: see Highway's foreach_target.h for why the guard is a toggle.
#if defined(IST_SIMD_EXACT_NODES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef IST_SIMD_EXACT_NODES_INL_H
#undef IST_SIMD_EXACT_NODES_INL_H
#else
#define IST_SIMD_EXACT_NODES_INL_H
#endif

#include <hwy/highway.h>

#include <bit>
#include <cmath>
#include <type_traits>

#include "simd/select-inl.h"
#include "simd/triangles/cluster_step.h"
#include "simd/triangles/sixteen-inl.h"

// Vector twins of the scalar forms in simd/triangles/triangle_lanes.h. No product is fused to a
// sum, so that the same nodes meet on every instruction set.
HWY_BEFORE_NAMESPACE();
namespace ist::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE Sixteen Dot(const Sixteen (&a)[3], const Sixteen (&b)[3]) {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}
HWY_INLINE Sixteen SineOf(const Sixteen& cosine) {
  return Sqrt(Max(Set16(0), Set16(1 + kSineRounding) - cosine * cosine));
}

// One node's bounds, in all lanes.
struct OneNode {
  Sixteen centre[3], rest[3], low[3], high[3], normal[3], offset, thickness, rim, radius;
};

template <class Block>
HWY_INLINE OneNode SetNode(const Block& block, std::size_t lane) {
  OneNode node;
  for (std::size_t i = 0; i < 3; ++i) {
    node.centre[i] = Set16(block.centre[i][lane]);
    node.normal[i] = Set16(block.normal[i][lane]);
    if constexpr (std::is_same_v<Block, TurnedBlock>) {
      node.rest[i] = Set16(block.rest[i][lane]);
      node.low[i] = Set16(block.low[i][lane]);
      node.high[i] = Set16(block.high[i][lane]);
    } else {
      node.rest[i] = Set16(0);
      node.low[i] = Set16(-block.half[i][lane]);
      node.high[i] = Set16(block.half[i][lane]);
    }
  }
  node.offset = Set16(block.offset[lane]);
  node.thickness = Set16(block.thickness[lane]);
  node.rim = Set16(block.rim[lane]);
  node.radius = Set16(block.radius[lane]);
  return node;
}

// Where one node's centre and box are from sixteen others'.
struct Apart {
  Sixteen centre[3], gap[3];

  template <class Block>
  HWY_INLINE Apart(const OneNode& one, const Block& block) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Sixteen from = one.centre[i] - Load16(block.centre[i]);
      Sixteen low, high;
      if constexpr (std::is_same_v<Block, TurnedBlock>) {
        centre[i] = from + (one.rest[i] - Load16(block.rest[i]));
        low = Load16(block.low[i]);
        high = Load16(block.high[i]);
      } else {
        centre[i] = from + one.rest[i];
        high = Load16(block.half[i]);
        low = Set16(0) - high;
      }
      gap[i] = Max(Max((centre[i] + one.low[i]) - high, low - (centre[i] + one.high[i])), Set16(0));
    }
  }
};

// The lanes that are not within `reach` of one node: their boxes are farther apart, or one disc is
// from the plane of the other.
template <class Block>
HWY_INLINE Truth16 FarNodes(const OneNode& one, const Block& block, const Sixteen& reach) {
  const Sixteen sizes = (one.radius + Load16(block.radius)) + reach;
  const Sixteen most = reach + sizes * Set16(kNodeRounding);
  const Apart apart(one, block);
  const Truth16 far = Dot(apart.gap, apart.gap) > most * most + Set16(kSquareUnderflow);
  const Sixteen normal[3] = {Load16(block.normal[0]), Load16(block.normal[1]),
                             Load16(block.normal[2])};
  const Sixteen offset = Load16(block.offset), thickness = Load16(block.thickness);
  const Sixteen cosine = Dot(normal, one.normal), size = Abs(cosine), sine = SineOf(cosine);
  const Sixteen from_lane = (Dot(normal, apart.centre) + cosine * one.offset) - offset;
  const Sixteen to_lane = ((thickness + size * one.thickness) + sine * one.rim) + most;
  const Sixteen from_one = (cosine * offset - Dot(one.normal, apart.centre)) - one.offset;
  const Sixteen to_one = ((one.thickness + size * thickness) + sine * Load16(block.rim)) + most;
  return (far | (Abs(from_lane) > to_lane)) | (Abs(from_one) > to_one);
}

// Vector twin of ist::turn_nodes_scalar.
inline void TurnNodes(const NodeBlock& moving, const ClusterPose& pose, TurnedBlock& out) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> half;
  using V = hn::Vec<decltype(d)>;
  const auto turned = [&](std::size_t i, V x, V y, V z) {
    const auto& r = pose.rotation[i];
    return hn::Add(hn::Add(hn::Mul(hn::Set(d, r[0]), x), hn::Mul(hn::Set(d, r[1]), y)),
                   hn::Mul(hn::Set(d, r[2]), z));
  };
  const V grid = hn::Set(d, pose.grid), cells = hn::Set(d, 1 / pose.grid);
  for (std::size_t lane = 0; lane < kClusterWidth; lane += hn::Lanes(d)) {
    const auto load = [&](const float* from) {
      return hn::PromoteTo(d, hn::Load(half, from + lane));
    };
    const auto store = [&](V v, float* to) { hn::Store(hn::DemoteTo(half, v), half, to + lane); };
    const V nx = load(moving.normal[0]), ny = load(moving.normal[1]), nz = load(moving.normal[2]);
    const V x = load(moving.centre[0]), y = load(moving.centre[1]), z = load(moving.centre[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      store(turned(i, nx, ny, nz), out.normal[i]);
      const V at = hn::Add(turned(i, x, y, z), hn::Set(d, pose.translation[i]));
      const auto near = hn::DemoteTo(half, hn::Mul(hn::Round(hn::Mul(at, cells)), grid));
      hn::Store(near, half, out.centre[i] + lane);
      store(hn::Sub(at, hn::PromoteTo(d, near)), out.rest[i]);
    }
  }
  const Sixteen offset = Load16(moving.offset), thickness = Load16(moving.thickness);
  const Sixteen rim = Load16(moving.rim);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto width = [&](std::size_t axis) {
      return Set16(static_cast<float>(std::abs(pose.rotation[i][axis]))) *
             Load16(moving.half[axis]);
    };
    const Sixteen box = (width(0) + width(1)) + width(2);
    const Sixteen normal = Load16(out.normal[i]), middle = offset * normal;
    const Sixteen disc = thickness * Abs(normal) + rim * SineOf(normal);
    Store16(Max(Set16(0) - box, middle - disc), out.low[i]);
    Store16(Min(box, middle + disc), out.high[i]);
  }
  Store16(offset, out.offset);
  Store16(thickness, out.thickness);
  Store16(rim, out.rim);
  Store16(Load16(moving.radius), out.radius);
}

// Vector twin of ist::meet_nodes_scalar.
inline void MeetNodes(const TurnedBlock& lanes, std::uint32_t lane_count, const FixedNodes& fixed,
                      LaneNodes nodes, float reach, std::uint32_t* HWY_RESTRICT bits) {
  const Sixteen within = Set16(reach);
  const Lanes16 all = FirstLanes(lane_count);
  for (std::size_t k = 0; k < nodes.count; ++k) {
    const std::uint32_t node = nodes.node(k);
    const OneNode one = SetNode(fixed.blocks[node / kClusterWidth], node % kClusterWidth);
    bits[k] = all & ~BitsOf(FarNodes(one, lanes, within));
  }
}

// Vector twin of ist::list_lanes_scalar.
inline std::size_t ListLanes(LaneNodes nodes, const std::uint32_t* HWY_RESTRICT bits,
                             std::uint32_t* HWY_RESTRICT out) {
  const FloatTag d;
  const IndexTag du;
  std::size_t found = 0;
  Lanes16 any = 0;
  for (std::size_t k = 0; k < nodes.count; ++k) any |= bits[k];
  for (; any != 0; any &= any - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(any));
    const IndexVec bit = hn::Set(du, std::uint32_t{1} << lane), name = hn::Set(du, lane);
    for (std::size_t k = 0; k < nodes.count; k += kLanes) {
      const auto near = hn::RebindMask(d, hn::TestBit(hn::LoadU(du, bits + k), bit));
      const IndexVec codes = hn::LoadU(du, nodes.codes + k);
      found += StoreSelected(d, hn::And(near, hn::FirstN(d, nodes.count - k)),
                             hn::Or(hn::And(codes, hn::Set(du, ~(kClusterWidth - 1))), name),
                             out + found);
    }
  }
  return found;
}

// Vector twin of ist::meet_children_scalar. No branch depends on how many are near, so that one
// test begins before the last one has ended, and the children of the test after that are loaded.
inline std::size_t MeetChildren(const TurnedBlock& lanes, const FixedNodes& children,
                                LaneNodes parents, float reach, std::uint32_t* HWY_RESTRICT out) {
  const FloatTag d;
  const IndexTag du;
  const Sixteen within = Set16(reach);
  const IndexVec numbers = hn::ShiftLeft<4>(hn::Iota(du, 0));
  std::size_t found = 0;
  for (std::size_t k = 0; k < parents.count; ++k) {
    load_ahead(children.blocks[parents.node(HWY_MIN(k + kItemsAhead, parents.count - 1))]);
    const std::uint32_t lane = parents.lane(k), parent = parents.node(k);
    const std::uint32_t count = children.children_of(parent);
    const Truth16 far = FarNodes(SetNode(lanes, lane), children.blocks[parent], within);
    for (std::size_t part = 0; part < kParts; ++part) {
      const auto first = static_cast<std::uint32_t>(part * kLanes);
      const auto there = hn::FirstN(d, HWY_MAX(count, first) - first);
      const IndexVec code =
          hn::Add(numbers, hn::Set(du, kClusterWidth * (kClusterWidth * parent + first) + lane));
      found += StoreSelected(d, hn::AndNot(far.part[part], there), code, out + found);
    }
  }
  return found;
}

// Vector twin of ist::score_children_scalar.
inline void ScoreChildren(const TurnedBlock& lanes, std::uint32_t lane, const NodeBlock& children,
                          float* scores) {
  const Apart apart(SetNode(lanes, lane), children);
  Store16(Dot(apart.gap, apart.gap) + Dot(apart.centre, apart.centre) * Set16(kCentreShare),
          scores);
}

}  // namespace ist::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
