#include "ist/query/promise/leaf_grid.h"

#include <algorithm>
#include <cmath>

namespace ist {

LeafGrid::LeafGrid(const SphereTree& tree, double radius)
    : lattice_(tree.lattice()), codes_(tree.octree().codes(0)) {
  while (level_ < lattice_.depth && lattice_.edge(level_) < 2 * radius) ++level_;
  for (std::uint32_t leaf = 0; leaf < codes_.size(); ++leaf) {
    runs_.try_emplace(codes_[leaf] >> 3 * level_, leaf);
  }
}

bool LeafGrid::cells_within(const Eigen::Vector3d& centre, double radius, Cells& low,
                            Cells& high) const noexcept {
  const double last = static_cast<double>(lattice_.cells) - 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = centre[static_cast<Eigen::Index>(i)];
    const double first_cell =
        std::floor((c - radius) / lattice_.voxel_size + lattice_.root_centre()) - 1;
    const double last_cell =
        std::floor((c + radius) / lattice_.voxel_size + lattice_.root_centre()) + 1;
    if (!(last_cell >= 0 && first_cell <= last)) return false;
    low[i] = static_cast<std::int64_t>(std::max(first_cell, 0.0));
    high[i] = static_cast<std::int64_t>(std::min(last_cell, last));
  }
  return true;
}

}  // namespace ist
