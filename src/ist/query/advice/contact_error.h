#pragma once

#include <Eigen/Geometry>
#include <span>

#include "ist/query/advice/closing_path.h"
#include "ist/query/advice/exact_bodies.h"
#include "ist/query/collision_query.h"

namespace ist {

/// How far apart surfaces still are, by their triangles, where voxels say that they touch, mesh
/// units: at most what CollisionQuery::resolution tells, and mostly far less.

/// At the first contact of a closing: from the touch outward along the path, in steps of 1/16 of a
/// voxel (and 1/64 of the way, where that is more), to where the surfaces are too far apart for any
/// contact, or touch again; the end of the contacts then by bisection. The largest distance at
/// which there are contacts. Cost: some 70 to 400 times 0.3 ms.
/// @param voxel_size the smaller one of `query`, mesh units
[[nodiscard]] double closing_error(ExactBodies& bodies, CollisionQuery& query, double voxel_size,
                                   const ClosingPath& path);

/// The largest at any of the poses; and between neighbours of equal rotation of which only one has
/// contacts, where contacts begin on the straight way from one to the other, by bisection. What is
/// between poses of different rotations is not looked at, for the way from one to the other is not
/// known. 0 where at no such pose surfaces are apart and voxels touch. Cost: 0.3 ms a pose.
[[nodiscard]] double error_at_poses(ExactBodies& bodies, CollisionQuery& query,
                                    std::span<const Eigen::Isometry3d> poses);

}  // namespace ist
