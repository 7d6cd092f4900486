#pragma once

#include "ist/query/contact.h"
#include "ist/query/relative_pose.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// Whether the balls of two roots touch, decided in double, and how far surfaces in them are apart.
struct RootTest {
  bool touch;
  double slack;  ///< what a test in double may err by, and a reach was grown by, mesh units
  GapInterval gap;
};

/// Precondition: both trees have `policy`. `grow` is added to the slack.
[[nodiscard]] RootTest test_roots(const SphereTree& fixed, const SphereTree& moving,
                                  SpherePolicy policy, const RelativePose& pose,
                                  double grow = 0) noexcept;

}  // namespace ist
