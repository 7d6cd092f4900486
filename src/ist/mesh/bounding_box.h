#pragma once

#include <Eigen/Geometry>

#include "ist/mesh/mesh.h"

namespace ist {

/// Returns the bounding box of the vertices that triangles use; empty without triangles. Cost:
/// O(triangles).
[[nodiscard]] inline Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh) noexcept {
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) box.extend(mesh.vertices[vertex]);
  return box;
}

}  // namespace ist
