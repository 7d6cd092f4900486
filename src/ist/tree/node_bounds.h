#pragma once

#include <Eigen/Core>
#include <vector>

#include "ist/tree/bound_blocks.h"

namespace ist {

/// What a node's bounds must hold, in lattice units.
struct Payload {
  std::vector<Eigen::Vector3d> points;  ///< whose convex hull it lies in; at least one
  Eigen::Vector3d area;                 ///< of its pieces together, a vector along their normals
  /// No point is farther from the truth, and half of it is kept for the arithmetic here.
  double slack;
};

/// The ball round a payload, its centre moved to the lattice of its block and its radius measured
/// from there, rounded up. At most 1 % above the smallest radius, and what the rounding costs: 3
/// units, and twice what the payload sticks out of the parent's cube.
///
/// @param parent_centre, parent_edge of the parent's cube, lattice units
[[nodiscard]] PackedBall pack_ball(const Payload& payload, const Eigen::Vector3d& parent_centre,
                                   double parent_edge) noexcept;

/// The centre of a packed ball, exact.
[[nodiscard]] Eigen::Vector3d centre_of(const PackedBall& ball,
                                        const Eigen::Vector3d& parent_centre,
                                        double parent_edge) noexcept;

/// A thin slab round a payload: its normal is the axis along which the points spread least or that
/// of the payload's area, whichever gives the thinner one, rounded to its block; its width is
/// measured along the rounded normal, and rounded up.
///
/// @param centre of the node's packed ball
/// @param edge   of the node's cube, lattice units
[[nodiscard]] PackedSlab pack_slab(const Payload& payload, const Eigen::Vector3d& centre,
                                   double edge) noexcept;

}  // namespace ist
