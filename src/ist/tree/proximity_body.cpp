#include "ist/tree/proximity_body.h"

#include <span>
#include <vector>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "ist/tree/bound_builder.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/morton.h"

namespace ist {
namespace {

// Returns the lattice of the proximity cells, which begins kMargin cells below the surface's
// lattice.
Lattice lattice_of_cells(const SphereTree& tree) {
  Lattice lattice = voxels_of(tree).lattice;
  for (double& corner : lattice.corner) corner -= ProximityTree::kMargin * lattice.voxel_size;
  lattice.cells += 2 * ProximityTree::kMargin;
  lattice.depth = voxels_of(tree).proximity->octree.depth();
  return lattice;
}

}  // namespace

SphereTree proximity_body(const SphereTree& tree) {
  const ScopedFloatEnvironment environment;
  IST_ASSERT(tree.has_proximity());
  const LinearOctree& octree = voxels_of(tree).proximity->octree;
  const Lattice lattice = lattice_of_cells(tree);
  BoundBuilder builder(SpherePolicy::kTight);
  const std::span<const OctreeNode> parents = octree.nodes(1);
  const std::vector<std::uint64_t> codes = octree.codes(0);
  builder.begin(lattice, parents.size() - 1);
  Payload payload{{}, Eigen::Vector3d::Zero(), 0x1p-48 * (2 * lattice.root_centre())};
  for (std::size_t parent = 0; parent + 1 < parents.size(); ++parent) {
    const std::uint32_t first = parents[parent].first_child;
    for (std::uint32_t leaf = first; leaf < parents[parent + 1].first_child; ++leaf) {
      const Cell cell = morton_decode(codes[leaf]);
      payload.points.assign(1, {cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5});
      builder.visit(parent, static_cast<int>(leaf - first), cell, payload);
    }
  }
  TreeParts parts;
  parts.voxels = TreeVoxels{lattice, octree, std::vector<PackedNormal>(octree.leaf_count()),
                            builder.finish(octree)};
  parts.orientation = tree.orientation();
  return tree_from(std::move(parts));
}

}  // namespace ist
