#include "ist/query/contacts/node_parents.h"

#include <algorithm>
#include <span>

namespace ist {

NodeParents::NodeParents(const LinearOctree& octree) {
  for (int level = 0; level <= octree.depth(); ++level) {
    const std::span<const OctreeNode> above = octree.nodes(level + 1);
    std::vector<std::uint32_t>& parents = parents_.emplace_back(above.back().first_child);
    for (std::uint32_t parent = 0; parent + 1 < above.size(); ++parent) {
      std::fill(parents.begin() + above[parent].first_child,
                parents.begin() + above[parent + 1].first_child, parent);
    }
  }
}

std::size_t NodeParents::bytes() const noexcept {
  std::size_t bytes = 0;
  for (const auto& level : parents_) bytes += level.size() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace ist
