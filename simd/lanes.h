#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ist/base/set_bits.h"
#include "ist/tree/lookup_table.h"
#include "simd/step.h"

namespace ist {

/// The numbers of a node's bound, one array each.
enum Lane : std::size_t { kX, kY, kZ, kRadius, kNormalX, kNormalY, kNormalZ, kOffset, kHalf };
inline constexpr std::size_t kLanes = 9;

/// The factor by which normals, offsets and half widths are scaled in blocks, so that a normal is
/// whole numbers, and in moving lanes.
inline constexpr float kSlabScale = 128;

/// The bounds of up to N nodes in their tree's frame, mesh units, side by side for vectors, and the
/// ids that survivors get. Room for a vector lies behind them.
template <std::size_t N>
struct alignas(64) BoundLanes {
  static constexpr std::size_t kSize = N;
  float lane[kLanes][N + 16];
  std::uint32_t id[N + 16];
};

/// The moving nodes of a batch of groups, one group after the other.
using MovingLanes = BoundLanes<1024>;
/// The children of one fixed node.
using FixedLanes = BoundLanes<8>;

/// The children of one fixed node in the moving tree's frame, mesh units, one array a number.
/// Radius and half width include the pads.
struct alignas(64) FixedRows {
  float x[8], y[8], z[8], radius[8];
  float normal_x[8], normal_y[8], normal_z[8], offset[8], half[8];
  float scaled_radius[8];  ///< kSlabScale · (radius + the moving slabs' pad)
};

/// The surfaces in the children of one fixed node, where they are leaves: points in the moving
/// tree's frame, mesh units, and normals in the fixed one's.
struct alignas(64) FixedPoints {
  float x[8], y[8], z[8];
  const PackedNormal* normals;
  std::uint32_t first;  ///< the first child's address, 8 · parent + slot
};

/// The children of one fixed node, in all their forms.
struct FixedGroup {
  FixedRows rows;
  FixedPoints points;
  FixedLanes lanes;
};

/// The scratch memory of a step. One object belongs to one thread.
struct SearchScratch {
  static constexpr std::size_t kGroups = 8;
  MovingLanes moving;
  FixedGroup fixed[kGroups];
};

// The scalar forms, inline because the vector kernels share some of them. Each specifies its vector
// twin, which does the same operations in the same order.

/// Decodes the bound of the child in slot `slot` of a parent, from its blocks.
template <std::size_t N>
void decode_block(const SearchSide& side, std::uint32_t parent, std::uint32_t slot,
                  BoundLanes<N>& out, std::size_t at) noexcept {
  const OctreeNode& node = side.nodes[parent];
  const BallBlock& ball = side.balls[parent];
  const float unit = side.ball_unit;
  out.lane[kX][at] = node.centre[0] * side.voxel_size + static_cast<float>(ball.x[slot]) * unit;
  out.lane[kY][at] = node.centre[1] * side.voxel_size + static_cast<float>(ball.y[slot]) * unit;
  out.lane[kZ][at] = node.centre[2] * side.voxel_size + static_cast<float>(ball.z[slot]) * unit;
  out.lane[kRadius][at] = static_cast<float>(ball.r[slot]) * unit;
  if (side.slabs == nullptr) return;
  const SlabBlock& slab = side.slabs[parent];
  out.lane[kNormalX][at] = static_cast<float>(slab.nx[slot]);
  out.lane[kNormalY][at] = static_cast<float>(slab.ny[slot]);
  out.lane[kNormalZ][at] = static_cast<float>(slab.nz[slot]);
  out.lane[kOffset][at] = static_cast<float>(slab.offset[slot]) * side.slab_unit;
  out.lane[kHalf][at] = static_cast<float>(slab.half[slot]) * side.slab_unit;
}

/// Decodes the sphere of the child in slot `slot` of a parent, from the parent's occupancy mask and
/// its own. Inline, because a call for each child costs a fifth of a step of four lanes.
template <std::size_t N>
[[gnu::always_inline]] inline void decode_implicit(const SearchSide& side, std::uint32_t parent,
                                                   std::uint32_t slot, BoundLanes<N>& out,
                                                   std::size_t at) noexcept {
  const OctreeNode& node = side.nodes[parent];
  const ImplicitLevel& level = *side.implicit;
  const unsigned octant = kSetBits[side.masks[parent]][slot];
  const float offsets[2] = {-side.octant_offset, side.octant_offset};  // no octant is foreseen
  float x = node.centre[0] * side.voxel_size + offsets[octant & 1];
  float y = node.centre[1] * side.voxel_size + offsets[octant >> 1 & 1];
  float z = node.centre[2] * side.voxel_size + offsets[octant >> 2];
  float radius = level.radius[kCircumsphereCode];
  if (level.masks != nullptr) {
    const std::uint32_t word = kTableWords[level.masks[node.first_child + slot]];
    x += level.offset[word & 7];
    y += level.offset[word >> 3 & 7];
    z += level.offset[word >> 6 & 7];
    radius = level.radius[word >> 9];
  }
  out.lane[kX][at] = x;
  out.lane[kY][at] = y;
  out.lane[kZ][at] = z;
  out.lane[kRadius][at] = radius;
}

[[nodiscard]] inline std::uint32_t child_count(const SearchSide& side,
                                               std::uint32_t parent) noexcept {
  return side.nodes[parent + 1].first_child - side.nodes[parent].first_child;
}

/// Returns the number of lanes that decode() makes of a frontier's `node`.
[[nodiscard]] inline std::uint32_t opened(const SearchSide& side, std::uint32_t node) noexcept {
  return side.descends ? child_count(side, node) : 1;
}

/// Decodes the children of a frontier's `node` into lanes from `at` on, or the node itself where
/// the side does not descend. Returns the number of lanes, at most 8.
template <std::size_t N>
std::uint32_t decode(const SearchSide& side, std::uint32_t node, BoundLanes<N>& out,
                     std::size_t at) noexcept {
  const std::uint32_t parent = side.descends ? node : node / 8;
  const std::uint32_t slot = side.descends ? 0 : node % 8;
  const std::uint32_t count = opened(side, node);
  const std::uint32_t name = !side.descends     ? node
                             : side.emits_slots ? 8 * node
                                                : side.nodes[node].first_child;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (side.balls != nullptr) {
      decode_block(side, parent, slot + i, out, at + i);
    } else {
      decode_implicit(side, parent, slot + i, out, at + i);
    }
    out.id[at + i] = name + i;
  }
  return count;
}

/// Turns the fixed node in lane `at` into the moving tree's frame, as a row.
template <class Lanes, class Rows>
void turn(const SearchPose& pose, const Pads& pads, bool slabs, const Lanes& fixed, std::size_t at,
          Rows& rows) noexcept {
  const float* r = pose.rotation;
  const float x = fixed.lane[kX][at], y = fixed.lane[kY][at], z = fixed.lane[kZ][at];
  rows.x[at] = ((r[0] * x + r[1] * y) + r[2] * z) + pose.translation[0];
  rows.y[at] = ((r[3] * x + r[4] * y) + r[5] * z) + pose.translation[1];
  rows.z[at] = ((r[6] * x + r[7] * y) + r[8] * z) + pose.translation[2];
  rows.radius[at] = fixed.lane[kRadius][at] + pads.ball;
  if (!slabs) return;
  constexpr float kUnscale = 1 / kSlabScale;
  const float nx = fixed.lane[kNormalX][at] * kUnscale, ny = fixed.lane[kNormalY][at] * kUnscale,
              nz = fixed.lane[kNormalZ][at] * kUnscale;
  rows.normal_x[at] = (r[0] * nx + r[1] * ny) + r[2] * nz;
  rows.normal_y[at] = (r[3] * nx + r[4] * ny) + r[5] * nz;
  rows.normal_z[at] = (r[6] * nx + r[7] * ny) + r[8] * nz;
  rows.offset[at] = fixed.lane[kOffset][at] * kUnscale;
  rows.half[at] = fixed.lane[kHalf][at] * kUnscale + pads.slab_fixed;
  rows.scaled_radius[at] = (fixed.lane[kRadius][at] + pads.slab_moving) * kSlabScale;
}

/// The numbers by which the bounds of a row and of a moving node are tested. The bounds overlap
/// unless a number exceeds its limit: `squared` that of the balls, squared; the others exist with
/// slabs alone.
struct PairTest {
  float squared, radius_sum;      ///< of the distance of the centres; `radius_sum` is not squared
  float over_fixed, fixed_sum;    ///< height of the moving centre over the fixed slab's middle
  float over_moving, moving_sum;  ///< of the fixed centre over the moving slab's, · kSlabScale

  template <class Rows, class Lanes>
  PairTest(const Rows& f, std::size_t row, const Lanes& m, std::size_t at, bool slabs) noexcept
      : over_fixed(0), fixed_sum(0), over_moving(0), moving_sum(0) {
    const float dx = m.lane[kX][at] - f.x[row], dy = m.lane[kY][at] - f.y[row],
                dz = m.lane[kZ][at] - f.z[row];
    squared = (dx * dx + dy * dy) + dz * dz;
    radius_sum = m.lane[kRadius][at] + f.radius[row];
    if (!slabs) return;
    over_fixed = std::abs(((dx * f.normal_x[row] + dy * f.normal_y[row]) + dz * f.normal_z[row]) -
                          f.offset[row]);
    fixed_sum = m.lane[kRadius][at] + f.half[row];
    over_moving = std::abs(
        ((dx * m.lane[kNormalX][at] + dy * m.lane[kNormalY][at]) + dz * m.lane[kNormalZ][at]) +
        m.lane[kOffset][at]);
    moving_sum = m.lane[kHalf][at] + f.scaled_radius[row];
  }

  /// Rejects by `>`, so that a NaN keeps the pair.
  [[nodiscard]] bool overlap() const noexcept {
    return !(squared > radius_sum * radius_sum) && !(over_fixed > fixed_sum) &&
           !(over_moving > moving_sum);
  }

  /// Updates the upper bound by the pair.
  void measure_upper(DistanceBounds& bounds) const noexcept {
    bounds.upper = std::min(bounds.upper, std::sqrt(squared) + radius_sum);
  }
  /// Updates the lower bound by a pair that is not descended. The distance of a pair that slabs
  /// separate is the largest of its three separations.
  void measure_lower(bool slabs, DistanceBounds& bounds) const noexcept {
    const float distance = std::sqrt(squared);
    float apart = distance - radius_sum;
    if (slabs) {
      apart = std::max(apart, over_fixed - fixed_sum);
      apart = std::max(apart, (over_moving - moving_sum) * (1 / kSlabScale));
    }
    bounds.lower = std::min(bounds.lower, apart);
  }
};

}  // namespace ist
