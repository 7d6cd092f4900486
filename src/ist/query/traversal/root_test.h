#pragma once

#include "ist/query/relative_pose.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// The test of the two root balls, in double, and the distance of the surfaces in them.
struct RootTest {
  bool overlap;  ///< with the pad of inner nodes: no search in float would find a pair if not
  /// The rounding error of a test in double and the margin, mesh units: the interval allows for it.
  double pad;
  DistanceInterval distance;
};

/// Tests the two roots; `margin`, mesh units, is added to the sum of radii. Precondition: both
/// trees have `policy`.
[[nodiscard]] RootTest test_roots(const SphereTree& fixed, const SphereTree& moving,
                                  SpherePolicy policy, const RelativePose& pose,
                                  double margin = 0) noexcept;

}  // namespace ist
