#pragma once

#include "ist/query/relative_pose.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// Whether the balls of two roots touch, decided in double.
struct RootTest {
  bool touch;
  double slack;  ///< what a test in double may err by, and a reach was grown by, mesh units
};

/// Precondition: both trees have `policy`.
[[nodiscard]] RootTest test_roots(const SphereTree& fixed, const SphereTree& moving,
                                  SpherePolicy policy, const RelativePose& pose) noexcept;

}  // namespace ist
