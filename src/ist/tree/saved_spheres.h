#pragma once

#include <vector>

#include "ist/tree/sphere_tree.h"

namespace ist {

/// Every node's sphere under one policy, in double and in the tree's frame: one array a level,
/// leaves first; under `slab` the balls alone. What "save the tree" costs in bytes, and what
/// statistics and pictures are made of.
using SavedSpheres = std::vector<std::vector<Ball>>;

/// Cost: 10 ns and 32 bytes a node. Precondition: tree.has(policy).
[[nodiscard]] SavedSpheres save_spheres(const SphereTree& tree, SpherePolicy policy);

/// The spheres of one level, in the octree's order. Precondition: tree.has(policy).
[[nodiscard]] std::vector<Ball> level_spheres(const SphereTree& tree, SpherePolicy policy,
                                              int level);

/// The cube centre of the node with this Morton code, in voxel edges from the root cube's centre.
[[nodiscard]] Eigen::Vector3d cube_centre(const Lattice& lattice, int level,
                                          std::uint64_t code) noexcept;

}  // namespace ist
