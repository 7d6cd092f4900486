#pragma once

#include <cstdint>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/voxel/voxel_set.h"

namespace ist {

/// The number of cells by which proximity cells may lie outside the grid on each side.
inline constexpr std::uint32_t kProximityMargin = 2;

/// Returns the proximity voxels of a mesh: cells that are not surface voxels and have their centre
/// outside the surface, at most two voxel edges from it. Winding numbers tell the outside of a
/// closed surface. For an open one the pseudonormal at the nearest point tells it: the face's
/// normal, or at an edge or a corner the angle-weighted mean of the adjacent normals.
///
/// @param surface the mesh's surface voxels
/// @return Morton codes, ascending, of cells counted from kProximityMargin below the grid's corner
/// on each axis; the same for any number of threads
///
/// Throws kVoxelSizeTooSmall if the grid has no room for the margin.
/// Cost: some 200 cells a surface voxel and triangle, and 1.5 µs a triangle of a closed surface.
/// Source: the classes of W. A. McNeely et al., Six degree-of-freedom haptic rendering using voxel
/// sampling, SIGGRAPH 1999; the sign, J. A. Bærentzen and H. Aanæs, Signed distance computation
/// using the angle weighted pseudonormal, IEEE TVCG 11(3), 2005.
[[nodiscard]] std::vector<std::uint64_t> proximity_voxels(const TriangleMesh& mesh,
                                                          const VoxelSet& surface);

}  // namespace ist
