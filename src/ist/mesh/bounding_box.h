#pragma once

#include <Eigen/Geometry>

#include "ist/mesh/triangle_mesh.h"

namespace ist {

/// Round the vertices that triangles name; empty where there are no triangles. Cost: O(triangles).
[[nodiscard]] Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh) noexcept;

}  // namespace ist
