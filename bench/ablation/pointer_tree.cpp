#include "ablation/pointer_tree.h"

#include <utility>

namespace ist::bench {

PointerTree::PointerTree(const LinearOctree& octree)
    : root_(make(octree, octree.depth(), 0, Eigen::Vector3d::Zero())) {}

std::unique_ptr<PointerNode> PointerTree::make(const LinearOctree& octree, int level,
                                               std::uint32_t index,
                                               const Eigen::Vector3d& cube_centre) {
  ++nodes_;
  auto node = std::make_unique<PointerNode>();
  node->cube_centre = cube_centre;
  node->level = level;
  node->index = index;
  node->mask = level == 0 ? std::uint8_t{0} : octree.mask(level, index);
  if (level == 0) return node;
  const double half = 0.5 * static_cast<double>(std::uint64_t{1} << (level - 1));
  std::uint32_t child = octree.first_child(level, index);
  for (unsigned k = 0; k < 8; ++k) {
    if ((node->mask >> k & 1) == 0) continue;
    node->children[k] = make(octree, level - 1, child++,
                             {cube_centre[0] + ((k & 1) != 0 ? half : -half),
                              cube_centre[1] + ((k & 2) != 0 ? half : -half),
                              cube_centre[2] + ((k & 4) != 0 ? half : -half)});
  }
  return node;
}

}  // namespace ist::bench
