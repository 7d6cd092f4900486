#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

namespace ist {

/// The bounds of a node in double, in a tree's frame.
struct Bounds {
  Ball ball;
  Slab slab;  ///< of policy slab
};

/// Returns the parent, at `level` + 1, of a node at `level`. Cost: O(log nodes).
[[nodiscard]] std::uint32_t parent_of(const LinearOctree& octree, int level,
                                      std::uint32_t node) noexcept;

/// Reads the saved bounds of a leaf. Precondition: tree.has(policy), and the policy is not
/// implicit.
[[nodiscard]] Bounds read_bounds(const SphereTree& tree, SpherePolicy policy,
                                 std::uint32_t leaf) noexcept;

/// Returns the bounds mapped by a motion between two trees' frames.
[[nodiscard]] Bounds moved(const Eigen::Isometry3d& motion, Bounds bounds) noexcept;

/// Returns the overlap of two bounds in one frame, mesh units, by the test that finds least; below
/// 0 if they are apart.
[[nodiscard]] double overlap(SpherePolicy policy, const Bounds& a, const Bounds& b) noexcept;

}  // namespace ist
