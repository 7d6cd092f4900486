#pragma once

#include <cstdint>
#include <vector>

#include "ist/tree/bounds.h"
#include "ist/tree/sphere_tree.h"
#include "ist/voxel/lattice.h"

namespace ist {

/// The spheres of all nodes under one policy, in double and in the tree's frame: one array a level,
/// leaves first; under `slab` the balls alone. They show the memory of a saved tree, and serve
/// statistics and pictures.
using SavedSpheres = std::vector<std::vector<Ball>>;

/// Returns the spheres of all nodes. Precondition: tree.has(policy). Cost: 10 ns and 32 bytes a
/// node.
[[nodiscard]] SavedSpheres save_spheres(const SphereTree& tree, SpherePolicy policy);

/// Returns the spheres of one level, in the octree's order. Precondition: tree.has(policy).
[[nodiscard]] std::vector<Ball> level_spheres(const SphereTree& tree, SpherePolicy policy,
                                              int level);

/// Returns the cube centre of the node with this Morton code, in voxel edges from the root cube's
/// centre.
[[nodiscard]] Eigen::Vector3d cube_centre(const Lattice& lattice, int level,
                                          std::uint64_t code) noexcept;

/// The statistics of one level under one policy.
struct LevelSpheres {
  SpherePolicy policy;
  double volume;        ///< sum over all balls of the level, mesh units cubed
  double milliseconds;  ///< to compute all spheres, or read saved ones, on one core
};

/// The statistics of one level of a tree, as in the article's figures 8 and 9.
struct LevelStatistics {
  int level;    ///< 0 for the leaves
  double edge;  ///< of a node's cube, mesh units
  std::uint32_t nodes;
  std::vector<LevelSpheres> spheres;  ///< one entry for each policy of the tree
};

/// Returns the statistics of all levels, leaves first; none without voxels. Cost: 20 ns a node and
/// policy, and 32 bytes a node of the largest level.
[[nodiscard]] std::vector<LevelStatistics> level_statistics(const SphereTree& tree);

/// Returns the volume of a voxel's circumsphere, (√3/2) π s³: the article's unit of volume.
[[nodiscard]] double unit_ball_volume(double voxel_size) noexcept;

}  // namespace ist
