#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "ist/tree/bound_blocks.h"
#include "ist/voxel/payload.h"

namespace ist {

/// Rounds the centre of a ball to the lattice of its block. Returns the ball without a radius.
///
/// @param parent_centre, parent_edge of the parent's cube, lattice units
[[nodiscard]] PackedBall pack_centre(const Eigen::Vector3d& centre,
                                     const Eigen::Vector3d& parent_centre,
                                     double parent_edge) noexcept;

/// Returns a radius in units of its block, rounded up.
[[nodiscard]] std::uint16_t pack_radius(double radius, double parent_edge) noexcept;

/// Returns the centre of a packed ball, exact.
[[nodiscard]] inline Eigen::Vector3d centre_of(const PackedBall& ball,
                                               const Eigen::Vector3d& parent_centre,
                                               double parent_edge) noexcept {
  const double unit = PackedBall::kUnit * parent_edge;
  return {parent_centre[0] + unit * ball.x, parent_centre[1] + unit * ball.y,
          parent_centre[2] + unit * ball.z};
}

/// The extent of a slab's content along a packed normal, from the centre of the node's packed ball.
struct Extent {
  PackedSlab normal;  ///< only the normal is set
  double least, greatest;
};

/// Packs the thinnest slab that holds an extent, inflated by a pad, rounded up: half a unit of the
/// offset and one of the width. If the numbers of a slab do not reach so far, returns one that
/// holds everything.
///
/// @param edge of the node's cube, lattice units
[[nodiscard]] PackedSlab pack_slab(const Extent& extent, double pad, double edge) noexcept;

/// Packs a ball round a payload: rounds the centre, and measures the radius from there. The radius
/// exceeds the smallest by at most 1 % and the rounding: 3 units, and twice the distance by which
/// the payload leaves the parent's cube.
///
/// @param parent_centre, parent_edge of the parent's cube, lattice units
[[nodiscard]] PackedBall pack_ball(const Payload& payload, const Eigen::Vector3d& parent_centre,
                                   double parent_edge) noexcept;

/// Packs a thin slab round a payload. The normal is the axis of the points' least spread or the
/// direction of the payload's area, whichever gives the thinner slab, rounded to its block; the
/// width is measured along the rounded normal. A flat payload has the direction of its area.
///
/// @param centre of the node's packed ball
/// @param edge   of the node's cube, lattice units
[[nodiscard]] PackedSlab pack_slab(const Payload& payload, const Eigen::Vector3d& centre,
                                   double edge) noexcept;

}  // namespace ist
