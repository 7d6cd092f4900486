#pragma once

#include <Eigen/Core>
#include <vector>

#include "ist/tree/bound_blocks.h"

namespace ist {

/// The geometry that a node's bounds must hold, in lattice units.
struct Payload {
  std::vector<Eigen::Vector3d> points;  ///< their convex hull holds the geometry; at least one
  Eigen::Vector3d area;                 ///< sum of the pieces' vector areas, up to a factor
  /// A bound of the points' errors, half of it reserved for the arithmetic of these functions.
  double pad;
};

/// Packs a ball round a payload: rounds the centre to the lattice of its block, and measures the
/// radius from there, rounded up. The radius exceeds the smallest by at most 1 % and the rounding:
/// 3 units, and twice the distance by which the payload leaves the parent's cube.
///
/// @param parent_centre, parent_edge of the parent's cube, lattice units
[[nodiscard]] PackedBall pack_ball(const Payload& payload, const Eigen::Vector3d& parent_centre,
                                   double parent_edge) noexcept;

/// Returns the centre of a packed ball, exact.
[[nodiscard]] Eigen::Vector3d centre_of(const PackedBall& ball,
                                        const Eigen::Vector3d& parent_centre,
                                        double parent_edge) noexcept;

/// Packs a thin slab round a payload. The normal is the axis of the points' least spread or the
/// direction of the payload's area, whichever gives the thinner slab, rounded to its block; the
/// width is measured along the rounded normal, and rounded up.
///
/// @param centre of the node's packed ball
/// @param edge   of the node's cube, lattice units
[[nodiscard]] PackedSlab pack_slab(const Payload& payload, const Eigen::Vector3d& centre,
                                   double edge) noexcept;

}  // namespace ist
