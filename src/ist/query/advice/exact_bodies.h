#pragma once

#include <Eigen/Geometry>

#include "ist/query/collision_query.h"
#include "ist/query/inside.h"

namespace ist {

/// Two bodies as their triangles are, whatever voxels say: what voxels are measured against.
class ExactBodies {
 public:
  /// Both trees hold triangles and outlive it; how large their voxels are changes the cost alone.
  ExactBodies(const SphereTree& fixed, const SphereTree& moving);

  /// Whether they neither touch nor one lies inside the other. Cost: 0.1 to 1 ms.
  [[nodiscard]] bool free(const Eigen::Isometry3d& pose) noexcept;
  /// The distance of the surfaces, mesh units (CollisionQuery::gap); 0 where they touch.
  [[nodiscard]] GapInterval distance(const Eigen::Isometry3d& pose, double tolerance) noexcept;

  [[nodiscard]] const TriangleMesh& fixed() const noexcept { return fixed_; }
  [[nodiscard]] const TriangleMesh& moving() const noexcept { return moving_; }
  /// Round the triangles, each in its own mesh's coordinates.
  [[nodiscard]] const Eigen::AlignedBox3d& fixed_box() const noexcept { return fixed_box_; }
  [[nodiscard]] const Eigen::AlignedBox3d& moving_box() const noexcept { return moving_box_; }

 private:
  const TriangleMesh& fixed_;
  const TriangleMesh& moving_;
  Eigen::AlignedBox3d fixed_box_, moving_box_;
  CollisionQuery query_;
  InsideTest inside_;
};

}  // namespace ist
