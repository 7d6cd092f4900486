#pragma once

#include "ist/tree/bound_blocks.h"
#include "ist/tree/linear_octree.h"
#include "support/exact.h"

namespace ist::test {

/// A saved bound in rational numbers, voxels from the root cube's centre.
struct ExactBound {
  ExactPoint centre;
  mpq_class radius;
  ExactPoint normal;  ///< zero without slabs
  mpq_class offset, half;
};

/// Unpacks child `slot` of `parent`, a node at `level`, from the description of the blocks.
[[nodiscard]] ExactBound exact_bound(const BoundBlocks& bounds, const LinearOctree& octree,
                                     int level, std::uint32_t parent, int slot);

/// Whether the ball of one bound holds that of the other, whole.
[[nodiscard]] bool holds_ball(const ExactBound& outer, const ExactBound& inner);

/// Whether normal · (x - from) is at most `limit` for all x within `partner_radius` of a bound:
/// those with |x - c| <= radius + partner radius and |n · (x - c) - offset| <= half + partner
/// radius. Decided in rational numbers; a normal of a bound, and a partner radius that leaves
/// something of the bound.
[[nodiscard]] bool stays_below(const ExactBound& bound, const mpq_class& partner_radius,
                               const ExactPoint& normal, const ExactPoint& from,
                               const mpq_class& limit);

/// Whether a slab is nested over a leaf for a partner of `partner_radius`, counting as wider by
/// `rise`.
[[nodiscard]] bool is_nested(const ExactBound& outer, const ExactBound& leaf,
                             const mpq_class& partner_radius, const mpq_class& rise = 0);

}  // namespace ist::test
