#include "ist/tree/saved_spheres.h"

namespace ist {

Eigen::Vector3d cube_centre(const Lattice& lattice, int level, std::uint64_t code) noexcept {
  const Cell cell = morton_decode(code);
  const double edge = static_cast<double>(std::uint64_t{1} << level), root = lattice.root_centre();
  return {(cell[0] + 0.5) * edge - root, (cell[1] + 0.5) * edge - root,
          (cell[2] + 0.5) * edge - root};
}

std::vector<Ball> level_spheres(const SphereTree& tree, SpherePolicy policy, int level) {
  const LinearOctree& octree = tree.octree();
  std::vector<Ball> spheres;
  spheres.reserve(octree.node_count(level));
  if (is_implicit(policy)) {
    for (const std::uint64_t code : octree.codes(level)) {
      spheres.push_back(tree.ball(policy, level, static_cast<std::uint32_t>(spheres.size()),
                                  cube_centre(tree.lattice(), level, code)));
    }
    return spheres;
  }
  for (std::uint32_t parent = 0; parent < tree.balls(level).size(); ++parent) {
    for (int slot = 0; slot < octree.child_count(level + 1, parent); ++slot) {
      spheres.push_back(tree.saved_ball(level, parent, slot));
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

}  // namespace ist
