#pragma once

#include <algorithm>
#include <cstdint>

#include "ist/base/progress.h"
#include "ist/tree/bound_blocks.h"
#include "ist/tree/linear_octree.h"

/// Bounds of inner nodes are nested: no two nodes come apart over two leaves whose bounds overlap
/// (docs/guarantees.md, Nested bounds).
namespace ist {

/// The partner radius of a test of two leaves is the other leaf's radius, with the margin and pads.
/// Slabs are nested for this one, in voxels: a partner of the same voxel size, at a margin of 3/8
/// voxel.
inline constexpr double kPartnerRadius = 1.25;

/// The part of a larger partner radius's excess by which slabs must count as wider.
inline constexpr double kPartnerRise = 1.0 / 3;

/// Returns by how much the slabs of a tree's inner nodes must count as wider for a partner radius,
/// mesh units.
[[nodiscard]] inline double slab_rise(double voxel_size, double partner_radius) noexcept {
  return kPartnerRise * std::max(0.0, partner_radius - kPartnerRadius * voxel_size);
}

/// The memory that slabs need while they are nested, bytes a node above the leaves.
inline constexpr std::uint64_t kNestingBytes = 80;

/// Fits the bounds of all nodes above the leaves from the leaves' bounds, as they are packed.
///  - A ball holds the balls of all its leaves. Its radius exceeds the smallest by at most 0.5 %,
///    and by the rounding.
///  - A slab is nested for kPartnerRadius. The leaves' slabs halve their balls in circles. The
///    normal is the axis along which these circles spread least, tilted once if that makes the slab
///    thinner.
///
/// @param pad    a bound of the arithmetic's errors: 2^-48 of the root cube's edge, voxels
/// @param bounds with the leaves fitted, and one empty array for each level above; filled in
///
/// Cost: on one core 0.3 µs a leaf with balls alone, 0.7 µs with slabs; memory 25 bytes a leaf with
/// slabs. + - × ÷ √ only; the same result for any number of threads.
void nest_bounds(const LinearOctree& octree, double pad, BoundBlocks& bounds, Progress& shown);

}  // namespace ist
