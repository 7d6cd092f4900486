#pragma once

#include <Eigen/Geometry>

#include "cli/bodies.h"
#include "ist/query/results.h"

namespace ist::cli {

/// Returns a point of the fixed triangle that is nearest to the moving one, fixed coordinates. It
/// lies on both if they intersect. Cost: 0.2 ms.
[[nodiscard]] Eigen::Vector3d shared_point(const Bodies& bodies, const TrianglePair& pair,
                                           const Eigen::Isometry3d& pose);

}  // namespace ist::cli
