#include "ist/tree/tree_statistics.h"

#include <chrono>

#include "ist/base/float_environment.h"
#include "ist/tree/saved_spheres.h"

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

double unit_ball_volume(double voxel_size) noexcept {
  return kSqrt3 / 2 * kPi * voxel_size * voxel_size * voxel_size;
}

std::vector<LevelStatistics> level_statistics(const SphereTree& tree) {
  const ScopedFloatEnvironment environment;
  std::vector<LevelStatistics> levels;
  for (int level = 0; level <= tree.depth(); ++level) {
    LevelStatistics& statistics = levels.emplace_back(
        LevelStatistics{level, tree.lattice().edge(level), tree.octree().node_count(level), {}});
    for (const SpherePolicy policy : kSpherePolicies) {
      if (tree.has(policy)) statistics.spheres.push_back(make(tree, policy, level));
    }
  }
  return levels;
}

}  // namespace ist
