#pragma once

#include "ist/query/relative_pose.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// The test of the two root balls, in double, and the distance of the surfaces in them.
struct RootTest {
  /// Within the margin and the pad of inner nodes: no search in float would find a pair if not.
  bool overlap;
  double pad;  ///< the rounding error of a test in double, mesh units: the interval allows for it
  DistanceInterval distance;
};

/// Tests the two roots, which overlap up to `margin`, mesh units, apart. Precondition: each tree
/// has `policy`, or no voxels.
[[nodiscard]] RootTest test_roots(const SphereTree& fixed, const SphereTree& moving,
                                  SpherePolicy policy, const RelativePose& pose,
                                  double margin = 0) noexcept;

}  // namespace ist
