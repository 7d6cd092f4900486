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

/// Returns whether the largest extent of a box lies in [1e-12, 1e15] units: no other mesh gets a
/// tree. In this range sums and products of lengths neither overflow nor vanish.
[[nodiscard]] inline bool has_usable_extent(const Eigen::AlignedBox3d& box) noexcept {
  const double extent = box.sizes().maxCoeff();
  return extent >= 1e-12 && extent <= 1e15;
}

}  // namespace ist
