#pragma once

#include <cstdint>
#include <vector>

#include "ist/mesh/triangle_mesh.h"
#include "ist/voxel/voxel_set.h"

namespace ist {

/// Proximity cells may lie this many cells outside the grid on each side.
inline constexpr std::uint32_t kProximityMargin = 2;

/// The proximity voxels of a mesh: cells whose centre lies outside the surface, at most two voxel
/// edges from it, and that are no surface voxels. Outside is the side that the normals of the
/// nearest place point to, recomputed from the winding; where the nearest place is an edge or a
/// corner, the angle-weighted mean of the normals round it.
///
/// @param surface the mesh's surface voxels
/// @return Morton codes, ascending, of cells counted from kProximityMargin below the grid's corner
///         on each axis. The same for any number of threads.
///
/// Throws kVoxelSizeTooSmall where the grid has no room left for the margin.
/// Cost: some 200 cells a surface voxel and triangle. Source: the classes of W. A. McNeely et al.,
/// Six degree-of-freedom haptic rendering using voxel sampling, SIGGRAPH 1999; the sign, J. A.
/// Bærentzen and H. Aanæs, Signed distance computation using the angle weighted pseudonormal, IEEE
/// TVCG 11(3), 2005.
[[nodiscard]] std::vector<std::uint64_t> proximity_voxels(const TriangleMesh& mesh,
                                                          const VoxelSet& surface);

}  // namespace ist
