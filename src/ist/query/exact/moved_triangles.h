#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "ist/mesh/mesh.h"
#include "ist/query/exact/triangles_meet.h"

namespace ist {

[[nodiscard]] inline TriangleCorners corners_of(const TriangleMesh& mesh,
                                                std::uint32_t triangle) noexcept {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// The triangles of a mesh at a pose. A vertex v is moved in double: ((r₀₀ v₀ + r₀₁ v₁) + r₀₂ v₂) +
/// t₀ and so on, with no product fused to a sum. All exact answers are about these doubles.
class MovedTriangles {
 public:
  /// Precondition: `pose` is rigid. Holds a reference to the mesh.
  MovedTriangles(const TriangleMesh& mesh, const Eigen::Isometry3d& pose) noexcept
      : mesh_(mesh), rotation_(pose.linear()), translation_(pose.translation()) {}

  [[nodiscard]] TriangleCorners operator[](std::uint32_t triangle) const noexcept {
    const Triangle& t = mesh_.triangles[triangle];
    return {moved(mesh_.vertices[t[0]]), moved(mesh_.vertices[t[1]]), moved(mesh_.vertices[t[2]])};
  }

 private:
  [[nodiscard]] Eigen::Vector3d moved(const Eigen::Vector3d& v) const noexcept {
    const Eigen::Matrix3d& r = rotation_;
    Eigen::Vector3d at;
    for (Eigen::Index i = 0; i < 3; ++i) {
      at[i] = ((r(i, 0) * v[0] + r(i, 1) * v[1]) + r(i, 2) * v[2]) + translation_[i];
    }
    return at;
  }

  const TriangleMesh& mesh_;
  // Not an Isometry3d, whose alignment depends on the instruction set.
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d translation_;
};

}  // namespace ist
