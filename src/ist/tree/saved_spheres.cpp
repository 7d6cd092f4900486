#include "ist/tree/saved_spheres.h"

#include <chrono>

#include "ist/base/float_environment.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

constexpr double kPi = 3.141592653589793;

LevelSpheres make(const SphereTree& tree, SpherePolicy policy, int level) {
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<Ball> spheres = level_spheres(tree, policy, level);
  const auto end = std::chrono::steady_clock::now();
  double cubes = 0;
  for (const Ball& ball : spheres) cubes += ball.radius * ball.radius * ball.radius;
  return {policy, 4 * kPi / 3 * cubes,
          std::chrono::duration<double, std::milli>(end - begin).count()};
}

}  // namespace

Eigen::Vector3d cube_centre(const Lattice& lattice, int level, std::uint64_t code) noexcept {
  const Cell cell = morton_decode(code);
  const double edge = static_cast<double>(std::uint64_t{1} << level), root = lattice.root_centre();
  return {(cell[0] + 0.5) * edge - root, (cell[1] + 0.5) * edge - root,
          (cell[2] + 0.5) * edge - root};
}

std::vector<Ball> level_spheres(const SphereTree& tree, SpherePolicy policy, int level) {
  const LinearOctree& octree = voxels_of(tree).octree;
  std::vector<Ball> spheres;
  spheres.reserve(octree.node_count(level));
  if (is_implicit(policy)) {
    for (const std::uint64_t code : octree.codes(level)) {
      spheres.push_back(voxels_of(tree).ball(policy, level,
                                             static_cast<std::uint32_t>(spheres.size()),
                                             cube_centre(voxels_of(tree).lattice, level, code)));
    }
    return spheres;
  }
  for (std::uint32_t parent = 0; parent < voxels_of(tree).balls(level).size(); ++parent) {
    for (int slot = 0; slot < octree.child_count(level + 1, parent); ++slot) {
      spheres.push_back(voxels_of(tree).saved_ball(level, parent, slot));
    }
  }
  return spheres;
}

SavedSpheres save_spheres(const SphereTree& tree, SpherePolicy policy) {
  SavedSpheres saved(static_cast<std::size_t>(tree.depth()) + 1);
  for (int level = 0; level <= tree.depth(); ++level) {
    saved[static_cast<std::size_t>(level)] = level_spheres(tree, policy, level);
  }
  return saved;
}

double unit_ball_volume(double voxel_size) noexcept {
  return kSqrt3 / 2 * kPi * voxel_size * voxel_size * voxel_size;
}

std::vector<LevelStatistics> level_statistics(const SphereTree& tree) {
  const ScopedFloatEnvironment environment;
  std::vector<LevelStatistics> levels;
  if (!tree.has_voxels()) return levels;
  for (int level = 0; level <= tree.depth(); ++level) {
    LevelStatistics& statistics = levels.emplace_back(LevelStatistics{
        level, voxels_of(tree).lattice.edge(level), voxels_of(tree).octree.node_count(level), {}});
    for (const SpherePolicy policy : kSpherePolicies) {
      if (tree.has(policy)) statistics.spheres.push_back(make(tree, policy, level));
    }
  }
  return levels;
}

}  // namespace ist
