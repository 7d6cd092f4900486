#pragma once

#include <Eigen/Geometry>

#include "ist/query/query.h"

namespace ist::test {

/// Two bodies, and a query of them.
struct BodyPair {
  BodyPair(const TriangleMesh& a, const TriangleMesh& b, double voxel_size = 0.5)
      : fixed(build_tree(a, {.voxel_size = voxel_size})),
        moving(build_tree(b, {.voxel_size = voxel_size})),
        query(fixed, moving) {}
  [[nodiscard]] bool meet(const Eigen::Isometry3d& pose) {
    return query.intersects(pose).answer == Answer::kYes;
  }

  SphereTree fixed, moving;
  Query query;
};

/// The moving body moved without a turn.
[[nodiscard]] inline Eigen::Isometry3d place(const Eigen::Vector3d& at) {
  return Eigen::Isometry3d(Eigen::Translation3d(at));
}

}  // namespace ist::test
