#pragma once

#include <Eigen/Geometry>

#include "ist/query/relative_pose.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

namespace ist::test {

/// How far the bounds of two leaves overlap, mesh units, by the search's own test that finds least:
/// of the balls, or of a ball and a slab; below 0 where they are apart. In double, without a pad.
[[nodiscard]] double leaf_overlap(const SphereTree& fixed, const SphereTree& moving,
                                  SpherePolicy policy, const RelativePose& pose,
                                  const LeafPair& pair);

/// The least overlap of all pairs of nodes that a search tests on its way to two leaves, theirs
/// included: the pair is in its answer while none of them is apart.
[[nodiscard]] double search_overlap(const SphereTree& fixed, const SphereTree& moving,
                                    SpherePolicy policy, const Eigen::Isometry3d& pose,
                                    const LeafPair& pair);

}  // namespace ist::test
