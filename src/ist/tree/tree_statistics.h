#pragma once

#include <cstdint>
#include <vector>

#include "ist/tree/sphere_tree.h"

namespace ist {

/// What one policy makes of one level.
struct LevelSpheres {
  SpherePolicy policy;
  double volume;        ///< of all balls of the level together, in cubes of the mesh unit
  double milliseconds;  ///< to make them all, on one core; for saved ones, to read them
};

/// One level of a tree, as the article's figures 8 and 9 show it.
struct LevelStatistics {
  int level;    ///< 0 for the leaves
  double edge;  ///< of a node's cube, mesh units
  std::uint32_t nodes;
  std::vector<LevelSpheres> spheres;  ///< one a policy that the tree has
};

/// Leaves first. Cost: 20 ns a node and policy, and 32 bytes a node of the largest level.
[[nodiscard]] std::vector<LevelStatistics> level_statistics(const SphereTree& tree);

/// The volume of a voxel's circumsphere, (√3/2) π s³: the article's unit of volume.
[[nodiscard]] double unit_ball_volume(double voxel_size) noexcept;

}  // namespace ist
