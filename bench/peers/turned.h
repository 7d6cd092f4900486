#pragma once

#include <vector>

#include "ist/mesh/mesh.h"
#include "peers/poses.h"

namespace ist::bench {

/// Degrees by which each mesh is turned.
inline constexpr double kFixedTurned = 46, kMovingTurned = 52;

/// The same bodies in other frames: each mesh turned about an oblique axis of its own, by
/// kFixedTurned and kMovingTurned, its vertices rounded to double, and poses that put them where
/// peer_poses() do. A scan has the axes of its scanner; here no axis of a box, a voxel or a grid
/// lies along a jaw, and no mesh's along the other's. Coordinates are rounded, so that counts may
/// differ from those of the meshes as they are given.
struct TurnedPair {
  TriangleMesh fixed, moving;
  std::vector<NamedPose> poses;
};
[[nodiscard]] TurnedPair turned_pair();

}  // namespace ist::bench
