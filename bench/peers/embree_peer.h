#pragma once

#include "peers/peer.h"

namespace ist::bench {

/// Embree: rtcCollide over two scenes of one user geometry each, in one thread; candidates are told
/// apart by their boxes and meet(), in double, so that all pairs are IST's. Embree cannot
/// be asked for a pose, so the moving mesh is moved, in vectors, and its hierarchy refitted. Three
/// contestants:
///  - `embree`: moves, refits, collides, tests triangles;
///  - `embree_no_refit`: the same, but moved and refitted before its time begins;
///  - `embree_boxes`: rtcCollide alone, which counts candidates and tests none; moved and refitted
///  before.
/// It cannot stop early and knows no distance between meshes.
[[nodiscard]] Library embree_library();

}  // namespace ist::bench
