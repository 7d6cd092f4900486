#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <vector>

#include "ist/query/manifold.h"
#include "ist/tree/sphere_tree.h"

namespace ist::test {

/// A pair of leaves with a weight, in fixed mesh coordinates.
struct PlainPair {
  std::uint32_t fixed, moving;
  double weight, depth;
  Eigen::Vector3d position, normal;
};

/// Every pair of leaves that has a weight, found without any search and worked out from what the
/// header guarantees: all leaves against all leaves, each with all its ancestors.
[[nodiscard]] std::vector<PlainPair> plain_pairs(const SphereTree& fixed, const SphereTree& moving,
                                                 SpherePolicy policy,
                                                 const Eigen::Isometry3d& pose);

[[nodiscard]] ContactSums plain_sums(const std::vector<PlainPair>& pairs, double voxel_size,
                                     const Eigen::Vector3d& about);

/// One contact a moving leaf.
[[nodiscard]] std::map<std::uint32_t, Contact> plain_points(const std::vector<PlainPair>& pairs);

}  // namespace ist::test
