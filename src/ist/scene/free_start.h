#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "ist/mesh/mesh.h"
#include "ist/query/query.h"

namespace ist {

/// Tests whether two bodies are free of each other at a pose, and finds the nearest free pose along
/// an axis.
class FreeStart {
 public:
  /// All arguments must outlive the object. If a mesh is null, a body inside the other one counts
  /// as free.
  FreeStart(const SphereTree& fixed, const SphereTree& held, const TriangleMesh* fixed_mesh,
            const TriangleMesh* held_mesh);

  enum class State { kFree, kIntersecting, kInside };
  [[nodiscard]] State at(const Eigen::Isometry3d& pose) noexcept;

  /// Finds the distance by which the held body must move along `axis`, a unit vector in fixed mesh
  /// coordinates, to be free, mesh units: 0, or the first multiple of a voxel at which it is free
  /// and one voxel more. Empty where none is within both bodies' extents. Cost: 20 to 300 µs a
  /// voxel.
  [[nodiscard]] std::optional<double> open_distance(const Eigen::Isometry3d& pose,
                                                    const Eigen::Vector3d& axis) noexcept;

 private:
  Query query_;
  std::optional<InsideTest> inside_;
  double voxel_, farthest_;
};

}  // namespace ist
