#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "ist/mesh/triangle_mesh.h"
#include "ist/query/collision_query.h"
#include "ist/query/inside.h"

namespace ist {

/// Whether two bodies are free of each other at a pose, and the nearest pose along an axis at which
/// they are.
class FreeStart {
 public:
  /// Without meshes it is not known whether one body is inside the other: then it is believed that
  /// none is. All must outlive it.
  FreeStart(const SphereTree& fixed, const SphereTree& held, const TriangleMesh* fixed_mesh,
            const TriangleMesh* held_mesh);

  enum class State { kFree, kTouching, kInside };
  [[nodiscard]] State at(const Eigen::Isometry3d& pose) noexcept;

  /// How far the held body must go along `axis`, a unit vector in fixed mesh coordinates, mesh
  /// units: the first multiple of a voxel at which it is free, and a voxel more where it had to be
  /// moved at all. Nothing if it never is within both bodies' extents. Cost: 20 to 300 µs a voxel.
  [[nodiscard]] std::optional<double> opening(const Eigen::Isometry3d& pose,
                                              const Eigen::Vector3d& axis) noexcept;

 private:
  CollisionQuery query_;
  std::optional<InsideTest> inside_;
  double voxel_, farthest_;
};

}  // namespace ist
