#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ist/base/platform/bit_cast.h"
#include "simd/contact_step.h"
#include "simd/lanes.h"

namespace ist {

// The scalar forms of contact sums. As in simd/lanes.h, each specifies its vector twin.

// As x86's min and max: the second number where one of them is NaN.
[[nodiscard]] inline float lesser(float a, float b) noexcept { return a < b ? a : b; }
[[nodiscard]] inline float greater(float a, float b) noexcept { return a > b ? a : b; }

/// Returns the index of the leaf that a step names `id`.
[[nodiscard]] inline std::uint32_t leaf_of(const SearchSide& side, std::uint32_t id) noexcept {
  return side.descends ? id : side.nodes[id / 8].first_child + id % 8;
}

/// Names the surfaces in the children of a frontier's fixed node.
inline void name_surfaces(const SearchStep& step, std::uint32_t node,
                          FixedPoints& points) noexcept {
  const SearchSide& side = step.fixed;
  points.first = side.descends ? 8 * node : node;
  points.normals =
      step.fixed_normals + (side.descends ? side.nodes[node].first_child : leaf_of(side, node));
}

/// Returns the place of a slab's middle along its normal, in lengths of that normal. Normals in
/// lanes are whole numbers, so 1 is below every square but 0.
[[nodiscard]] inline float middle_of(float nx, float ny, float nz, float offset) noexcept {
  return offset / greater((nx * nx + ny * ny) + nz * nz, 1);
}

/// Finds the surface point of the fixed leaf in lane `at`: the foot of the perpendicular from the
/// ball's centre to the slab's middle, or without slabs the centre.
template <class Lanes, class Rows, class Points>
void find_point(bool slabs, const Lanes& fixed, const Rows& rows, std::size_t at,
                Points& points) noexcept {
  points.x[at] = rows.x[at];
  points.y[at] = rows.y[at];
  points.z[at] = rows.z[at];
  if (!slabs) return;
  const float along = middle_of(fixed.lane[kNormalX][at], fixed.lane[kNormalY][at],
                                fixed.lane[kNormalZ][at], fixed.lane[kOffset][at]) *
                      kSlabScale;
  points.x[at] += along * rows.normal_x[at];
  points.y[at] += along * rows.normal_y[at];
  points.z[at] += along * rows.normal_z[at];
}

/// Returns the factor of a weight, 0 … 1, that the bounds of an overlapping pair give. It is 0
/// where the test drops the pair.
[[nodiscard]] inline float bound_share(const ContactRule& rule, const PairTest& test,
                                       bool slabs) noexcept {
  const float left = test.radius_sum * test.radius_sum - test.squared;
  const float balls = lesser(left * rule.per_ball, 1);
  if (!slabs) return balls;
  const float fixed = (test.fixed_sum - test.over_fixed) * rule.per_slab;
  const float moving = (test.moving_sum - test.over_moving) * rule.per_scaled_slab;
  return balls * lesser(lesser(fixed, moving), 1);
}

struct FloatVector {
  float x, y, z;
};

/// Returns the surface point of the moving leaf in lane `at`, in its tree's frame.
template <class Lanes>
[[nodiscard]] FloatVector moving_point(bool slabs, const Lanes& moving, std::size_t at) noexcept {
  FloatVector point{moving.lane[kX][at], moving.lane[kY][at], moving.lane[kZ][at]};
  if (!slabs) return point;
  const float nx = moving.lane[kNormalX][at], ny = moving.lane[kNormalY][at],
              nz = moving.lane[kNormalZ][at];
  const float along = middle_of(nx, ny, nz, moving.lane[kOffset][at]);
  point.x += along * nx;
  point.y += along * ny;
  point.z += along * nz;
  return point;
}

/// Appends a pair that overlaps.
inline void append_pair(const ContactRule& rule, const PairTest& test, const FixedPoints& points,
                        std::size_t row, const MovingLanes& moving, std::size_t at, bool slabs,
                        ContactLanes& out) noexcept {
  const std::size_t to = out.count++;
  out.share[to] = bound_share(rule, test, slabs);
  out.fixed_x[to] = points.x[row];
  out.fixed_y[to] = points.y[row];
  out.fixed_z[to] = points.z[row];
  out.fixed[to] = points.first + static_cast<std::uint32_t>(row);
  out.fixed_normal[to] = points.normals[row].word();
  const FloatVector point = moving_point(slabs, moving, at);
  out.moving_x[to] = point.x;
  out.moving_y[to] = point.y;
  out.moving_z[to] = point.z;
  out.moving[to] = moving.id[at];
}

/// Unpacks a leaf's normal (PackedNormal), as long as it is coherent. All is exact up to the root.
[[nodiscard]] inline FloatVector unpack_normal(std::uint32_t word) noexcept {
  constexpr int kHalf = 2047;
  float u = static_cast<float>(static_cast<int>(word >> 20) - kHalf);
  float v = static_cast<float>(static_cast<int>(word >> 8 & 4095) - kHalf);
  const float z = (kHalf - std::abs(u)) - std::abs(v);
  if (z < 0) {
    const float folded = std::copysign(kHalf - std::abs(v), u);
    v = std::copysign(kHalf - std::abs(u), v);
    u = folded;
  }
  const float coherence = static_cast<float>(static_cast<int>(word & 255)) * (1.0F / 255);
  const float scale = coherence / std::sqrt((u * u + v * v) + z * z);
  return {u * scale, v * scale, z * scale};
}

[[nodiscard]] inline FloatVector turned(const SearchPose& pose, const FloatVector& v) noexcept {
  const float* r = pose.rotation;
  return {(r[0] * v.x + r[1] * v.y) + r[2] * v.z, (r[3] * v.x + r[4] * v.y) + r[5] * v.z,
          (r[6] * v.x + r[7] * v.y) + r[8] * v.z};
}

/// Two normals whose sum is shorter than this, twice the length of their mean, give no weight that
/// is a unit.
inline constexpr float kShortestMean = 0x1p-40F;

/// The terms of a pair in the sums, as in ContactTerms.
struct PairTerms {
  float weight, depth;
  FloatVector position, force;
};

/// Computes the terms of a pair, of surface points f and m with normals a and b: all in the moving
/// tree's frame.
///
/// The direction n is that of e, the mean of the fixed normal and of the reversed moving one; the
/// weight is |e| times the share of the bounds and the part of the fade. A weight that is no number
/// counts as 0.
[[nodiscard]] inline PairTerms pair_terms(const ContactRule& rule, float share,
                                          const FloatVector& f, const FloatVector& m,
                                          const FloatVector& a, const FloatVector& b) noexcept {
  const FloatVector e{a.x - b.x, a.y - b.y, a.z - b.z};
  const float length = std::sqrt((e.x * e.x + e.y * e.y) + e.z * e.z);
  const float inverse = 1 / greater(length, kShortestMean);
  const FloatVector n{e.x * inverse, e.y * inverse, e.z * inverse};
  const float along = (n.x * (f.x - m.x) + n.y * (f.y - m.y)) + n.z * (f.z - m.z);
  PairTerms terms{};
  terms.depth = lesser(greater(along - rule.least, 0), rule.range);
  const float fade = lesser(rule.fade_from + terms.depth * rule.per_fade, 1);
  const float weight = (share * (length * (0.5F * kContactUnit))) * fade;
  const auto part = [&](float x) { return lesser(greater(x * rule.half_per_lever, -1), 1); };
  terms.position = {part(f.x + m.x), part(f.y + m.y), part(f.z + m.z)};
  if (!(weight > 0)) return terms;
  terms.weight = lesser(weight, kContactUnit);
  terms.force = {terms.weight * n.x, terms.weight * n.y, terms.weight * n.z};
  return terms;
}

/// The sum of it and of a term, at most 2²² without its sign, has 1 as its last bit.
inline constexpr float kToWhole = 0x1.8p23F;

/// Rounds a term to a whole number, ties to even.
[[nodiscard]] inline std::int32_t to_fixed_point(float term) noexcept {
  return bit_cast<std::int32_t>(term + kToWhole) - bit_cast<std::int32_t>(kToWhole);
}

/// Writes the terms of a pair at place `at` of a batch.
inline void store_terms(const PairTerms& pair, ContactTerms& terms, std::size_t at) noexcept {
  terms.weight[at] = pair.weight;
  terms.depth[at] = pair.depth;
  terms.x[at] = pair.position.x;
  terms.y[at] = pair.position.y;
  terms.z[at] = pair.position.z;
  terms.force_x[at] = pair.force.x;
  terms.force_y[at] = pair.force.y;
  terms.force_z[at] = pair.force.z;
}

/// Adds the terms of a pair to the sums.
inline void add_pair(const ContactRule& rule, const PairTerms& terms,
                     ContactTotals& totals) noexcept {
  const auto to = [&](std::size_t place, float term) { totals.sum[place] += to_fixed_point(term); };
  const FloatVector &p = terms.position, &f = terms.force;
  const FloatVector t{p.y * f.z - p.z * f.y, p.z * f.x - p.x * f.z, p.x * f.y - p.y * f.x};
  const float x = terms.depth * rule.per_range;
  to(kWeightSum, terms.weight);
  to(kForceSum, f.x);
  to(kForceSum + 1, f.y);
  to(kForceSum + 2, f.z);
  to(kTorqueSum, t.x);
  to(kTorqueSum + 1, t.y);
  to(kTorqueSum + 2, t.z);
  to(kSpringSum, f.x * x);
  to(kSpringSum + 1, f.y * x);
  to(kSpringSum + 2, f.z * x);
  to(kSpringTorqueSum, t.x * x);
  to(kSpringTorqueSum + 1, t.y * x);
  to(kSpringTorqueSum + 2, t.z * x);
  totals.counted += terms.weight > 0 ? 1 : 0;
}

}  // namespace ist
