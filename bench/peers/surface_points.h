#pragma once

#include <vector>

#include "ist/mesh/mesh.h"

namespace ist::bench {

/// Points on a mesh, no farther apart than `voxel_size`: of those in the same voxel of a lattice
/// through the origin one is kept. They go block by block, 8 voxels an edge, so that neighbours
/// follow each other. Precondition: fewer than 2^20 voxels to either side of the origin.
[[nodiscard]] std::vector<Eigen::Vector3d> surface_points(const TriangleMesh& mesh,
                                                          double voxel_size);

}  // namespace ist::bench
