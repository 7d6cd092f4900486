#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "ist/query/contacts/node_bound.h"

namespace ist {

/// A leaf as contacts are made of it, in a tree's frame, mesh units.
struct ContactLeaf {
  NodeBound bound;
  /// Where its surface is, as well as the policy knows: on the slab's middle, at the tight ball's
  /// centre, at the cube's centre.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// Outward, as long as it is coherent; zero where there is none.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();

  /// Moved to the fixed tree's frame.
  [[nodiscard]] ContactLeaf in(const RelativePose& pose) const noexcept {
    return {bound.in(pose), moved(pose, point), turned(pose, normal)};
  }
};

/// The surface point is no farther from the ball's centre, in voxel sizes: half the cube's edge, as
/// PackedSlab's offset allows, by how much a packed normal may be shorter than 1.
inline constexpr double kFarthestPoint = 0.52;

/// `parent` is the leaf's, at level 1. Precondition: tree.has(policy). Cost: 20 ns.
[[nodiscard]] ContactLeaf read_leaf(const SphereTree& tree, SpherePolicy policy, std::uint32_t leaf,
                                    std::uint32_t parent) noexcept;

}  // namespace ist
