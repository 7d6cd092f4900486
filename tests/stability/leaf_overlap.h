#pragma once

#include <Eigen/Geometry>

#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

namespace ist::test {

/// How far the bounds of two leaves overlap, mesh units, by the search's own test that finds least:
/// of the balls, or of a ball and a slab; below 0 where they are apart. In double, without a pad.
/// It decides whether a search finds them. `between` is the motion between_frames().
[[nodiscard]] double leaf_overlap(const SphereTree& fixed, const SphereTree& moving,
                                  SpherePolicy policy, const Eigen::Isometry3d& between,
                                  const LeafPair& pair);

}  // namespace ist::test
