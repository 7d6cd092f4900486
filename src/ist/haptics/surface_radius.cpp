#include "ist/haptics/surface_radius.h"

#include <algorithm>
#include <cmath>

namespace ist {

double surface_radius(const SphereTree& tree) noexcept {
  // The leaves' parents, whose cubes hold all of it. At level 1 there is one node more than are.
  double farthest2 = 0;
  const std::span<const OctreeNode> nodes = tree.octree().nodes(1);
  for (const OctreeNode& node : nodes.first(nodes.size() - 1)) {
    const double x = node.centre[0], y = node.centre[1], z = node.centre[2];
    farthest2 = std::max(farthest2, (x * x + y * y) + z * z);
  }
  // Of a parent's cube: half its diagonal, and a little for what rounding takes.
  return tree.lattice().voxel_size * (std::sqrt(farthest2) + std::sqrt(3.0)) * (1 + 1e-9);
}

}  // namespace ist
