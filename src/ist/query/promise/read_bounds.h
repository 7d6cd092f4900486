#pragma once

#include <cstdint>

#include "ist/query/relative_pose.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// A node's bounds in double, in a tree's frame.
struct Bounds {
  Ball ball;
  Slab slab;  ///< where the policy has one
};

/// The node at `level` + 1 whose child the node at `level` is. Cost: O(log nodes).
[[nodiscard]] std::uint32_t parent_of(const LinearOctree& octree, int level,
                                      std::uint32_t node) noexcept;

/// What is saved for a node. Precondition: tree.has(policy), which is not implicit.
[[nodiscard]] Bounds read_bounds(const SphereTree& tree, SpherePolicy policy, int level,
                                 std::uint32_t node) noexcept;

[[nodiscard]] Bounds moved(const RelativePose& pose, Bounds bounds) noexcept;

/// How far two bounds in one frame overlap, by the test that finds least; below 0 where they are
/// apart.
[[nodiscard]] double overlap(SpherePolicy policy, const Bounds& a, const Bounds& b) noexcept;

}  // namespace ist
