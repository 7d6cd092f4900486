#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "ist/base/rigid_move.h"
#include "ist/mesh/mesh.h"
#include "ist/mesh/triangles_meet.h"

namespace ist {

[[nodiscard]] inline TriangleCorners corners_of(const TriangleMesh& mesh,
                                                std::uint32_t triangle) noexcept {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// The triangles of a mesh at a pose. All exact answers are about these doubles.
class MovedTriangles {
 public:
  /// Precondition: `pose` is rigid. Holds a reference to the mesh.
  MovedTriangles(const TriangleMesh& mesh, const Eigen::Isometry3d& pose) noexcept
      : mesh_(mesh), moved_(pose) {}

  [[nodiscard]] TriangleCorners operator[](std::uint32_t triangle) const noexcept {
    const Triangle& t = mesh_.triangles[triangle];
    return {moved_(mesh_.vertices[t[0]]), moved_(mesh_.vertices[t[1]]),
            moved_(mesh_.vertices[t[2]])};
  }

 private:
  const TriangleMesh& mesh_;
  RigidMove moved_;
};

}  // namespace ist
