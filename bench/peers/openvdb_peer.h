#pragma once

#include "peers/peer.h"

namespace ist::bench {

/// OpenVDB, as one who has voxels would ask it: a narrow-band level set of the fixed jaw
/// (meshToLevelSet, voxels of 0.2 mm, 3 to either side), read where points of the moving jaw's
/// surface are, as Voxmap-PointShell does. Each point that is in the box of the
/// band reads the voxel that it is in, and the eight
/// round it only where that could change the answer. Two contestants:
///  - `openvdb`: one point for each voxel of 0.2 mm that the surface goes through, in the order of
///    the grid's leaves;
///  - `openvdb_vertices`: the moving mesh's vertices alone.
/// Differences: it samples. What lies between points, or is smaller than a voxel, is missed; a
/// point inside the fixed jaw touches, though no triangles meet; distances beyond the band are not
/// known. It has no pairs of triangles. The fixed mesh must be closed.
[[nodiscard]] Library openvdb_library();

}  // namespace ist::bench
