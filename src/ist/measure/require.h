#pragma once

#include <Eigen/Geometry>
#include <string_view>

#include "ist/base/api.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// Throws kTrianglesMissing, naming `body`, where the tree holds no triangles.
IST_LOOP_API void require_triangles(const SphereTree& tree, std::string_view body);

/// Returns the rigid motion of project_to_rigid(). Throws kPoseInvalid, naming `pose`, where it is
/// none.
[[nodiscard]] Eigen::Isometry3d require_rigid(const Eigen::Isometry3d& pose, std::string_view name);

/// Throws kArgumentInvalid for a tolerance that is NaN or negative.
void require_tolerance(double tolerance);

}  // namespace ist
