#include "support/exact_nesting.h"

#include <cstddef>

namespace ist::test {
namespace {

// Whether a + √b <= c, for b >= 0.
bool root_at_most(const mpq_class& b, const mpq_class& c) { return sgn(c) >= 0 && b <= c * c; }

}  // namespace

ExactBound exact_bound(const BoundBlocks& bounds, const LinearOctree& octree, int level,
                       std::uint32_t parent, int slot) {
  const auto index = static_cast<std::size_t>(level);
  const mpq_class edge = mpq_class(std::uint64_t{1} << level);
  const PackedBall ball = bounds.balls[index][parent][slot];
  const mpq_class unit = 2 * edge / 65536;
  const int place[] = {ball.x, ball.y, ball.z};
  ExactBound bound;
  for (std::size_t i = 0; i < 3; ++i) {
    bound.centre[i] = mpq_class(octree.nodes(level + 1)[parent].centre[i]) + place[i] * unit;
  }
  bound.radius = ball.r * unit;
  if (bounds.slabs.empty()) return bound;
  const PackedSlab slab = bounds.slabs[index][parent][slot];
  bound.normal =
      mpq_class(1, 128) * ExactPoint{{mpq_class(slab.nx), mpq_class(slab.ny), mpq_class(slab.nz)}};
  bound.offset = slab.offset * edge / 256;
  bound.half = slab.half * edge / 256;
  return bound;
}

bool holds_ball(const ExactBound& outer, const ExactBound& inner) {
  return root_at_most(square(inner.centre - outer.centre), outer.radius - inner.radius);
}

// Where the ball's point farthest along the normal lies beyond a face of the slab, the disc's point
// farthest along it counts: at (p · top + √((NN - p²/nn) nn (R² nn - top²))) / nn from the centre,
// with p = N · n, NN = |N|², nn = |n|², R = radius + partner radius and top = ±offset + half +
// partner radius.
bool stays_below(const ExactBound& bound, const mpq_class& partner_radius, const ExactPoint& normal,
                 const ExactPoint& from, const mpq_class& limit) {
  const mpq_class radius = bound.radius + partner_radius;
  const mpq_class squared = square(normal), own = square(bound.normal);
  const mpq_class left = limit - dot(normal, bound.centre - from);
  if (root_at_most(radius * radius * squared, left)) return true;  // the whole ball stays below
  for (const int side : {1, -1}) {
    const mpq_class along = side * dot(normal, bound.normal);
    const mpq_class top = side * bound.offset + bound.half + partner_radius;
    // Beyond this face: R p > top √NN.
    const bool beyond =
        sgn(top) >= 0 ? sgn(along) > 0 && radius * radius * along * along > top * top * squared
                      : sgn(along) >= 0 || radius * radius * along * along < top * top * squared;
    if (!beyond) continue;
    const mpq_class disc = (squared * own - along * along) * (radius * radius * own - top * top);
    return root_at_most(disc, left * own - along * top);
  }
  return false;
}

bool is_nested(const ExactBound& outer, const ExactBound& leaf, const mpq_class& partner_radius,
               const mpq_class& rise) {
  const mpq_class room = outer.half + partner_radius + rise;
  return stays_below(leaf, partner_radius, outer.normal, outer.centre, outer.offset + room) &&
         stays_below(leaf, partner_radius, mpq_class(-1) * outer.normal, outer.centre,
                     room - outer.offset);
}

}  // namespace ist::test
