#include "ist/tree/saved_spheres.h"

namespace ist {

Eigen::Vector3d cube_centre(const Lattice& lattice, int level, std::uint64_t code) noexcept {
  const Cell cell = morton_decode(code);
  const double edge = static_cast<double>(std::uint64_t{1} << level), root = lattice.root_centre();
  return {(cell[0] + 0.5) * edge - root, (cell[1] + 0.5) * edge - root,
          (cell[2] + 0.5) * edge - root};
}

std::vector<Ball> level_spheres(const SphereTree& tree, SpherePolicy policy, int level) {
  const std::vector<std::uint64_t> codes = tree.octree().codes(level);
  std::vector<Ball> spheres(codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    spheres[i] = tree.ball(policy, level, static_cast<std::uint32_t>(i),
                           cube_centre(tree.lattice(), level, codes[i]));
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
