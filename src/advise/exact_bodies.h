#pragma once

#include <Eigen/Geometry>

#include "ist/base/assert.h"
#include "ist/mesh/bounding_box.h"
#include "ist/query/query.h"
#include "ist/tree/tree_parts.h"

namespace ist {

/// Two bodies given by their triangles: the reference that voxels are measured against.
class ExactBodies {
 public:
  /// Uses the triangles of both trees, which must hold them and outlive this. Their voxel sizes
  /// do not matter.
  ExactBodies(const SphereTree& fixed, const SphereTree& moving)
      : fixed_(mesh_of(fixed)),
        moving_(mesh_of(moving)),
        fixed_box_(bounding_box(fixed_)),
        moving_box_(bounding_box(moving_)),
        query_(fixed, moving),
        inside_(fixed_, moving_) {}

  /// Returns whether the bodies neither intersect nor one lies inside the other. Cost: 0.1 to 1 ms.
  [[nodiscard]] bool free(const Eigen::Isometry3d& pose) noexcept {
    query_.forget();
    return query_.intersects(pose).answer == Answer::kNo && inside_.at(pose) == Inside::kNone;
  }
  /// Returns the distance between the surfaces, mesh units (Query::distance); 0 if they intersect.
  [[nodiscard]] DistanceInterval distance(const Eigen::Isometry3d& pose,
                                          double tolerance) noexcept {
    query_.forget();
    return query_.distance(pose, tolerance).distance;
  }

  [[nodiscard]] const TriangleMesh& fixed() const noexcept { return fixed_; }
  [[nodiscard]] const TriangleMesh& moving() const noexcept { return moving_; }
  /// The bounding boxes of the triangles, each in its own mesh's coordinates.
  [[nodiscard]] const Eigen::AlignedBox3d& fixed_box() const noexcept { return fixed_box_; }
  [[nodiscard]] const Eigen::AlignedBox3d& moving_box() const noexcept { return moving_box_; }

 private:
  static const TriangleMesh& mesh_of(const SphereTree& tree) {
    IST_ASSERT(tree.triangles() != nullptr);
    return tree.parts().triangles->mesh;
  }

  const TriangleMesh& fixed_;
  const TriangleMesh& moving_;
  Eigen::AlignedBox3d fixed_box_, moving_box_;
  Query query_;
  InsideTest inside_;
};

}  // namespace ist
