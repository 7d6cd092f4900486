#include "ist/tree/proximity_body.h"

#include <numeric>

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

// Gives each cell a degenerate triangle at its centre.
TriangleMesh centres_of(VoxelSet& voxels) {
  TriangleMesh mesh;
  const double size = voxels.lattice.voxel_size;
  for (const std::uint64_t code : voxels.codes) {
    const auto vertex = static_cast<std::uint32_t>(mesh.vertices.size());
    const Cell cell = morton_decode(code);
    mesh.vertices.emplace_back(voxels.lattice.corner[0] + (cell[0] + 0.5) * size,
                               voxels.lattice.corner[1] + (cell[1] + 0.5) * size,
                               voxels.lattice.corner[2] + (cell[2] + 0.5) * size);
    mesh.triangles.push_back({vertex, vertex, vertex});
  }
  voxels.triangles.first.resize(voxels.codes.size() + 1);
  voxels.triangles.ids.resize(voxels.codes.size());
  std::iota(voxels.triangles.first.begin(), voxels.triangles.first.end(), 0u);
  std::iota(voxels.triangles.ids.begin(), voxels.triangles.ids.end(), 0u);
  return mesh;
}

}  // namespace

SphereTree proximity_body(const SphereTree& tree) {
  const ScopedFloatEnvironment environment;
  IST_ASSERT(tree.has_proximity());
  const LinearOctree& octree = voxels_of(tree).proximity->octree;
  VoxelSet voxels{
      lattice_of_cells(tree), octree.codes(0), std::vector<PackedNormal>(octree.leaf_count()), {}};
  const TriangleMesh centres = centres_of(voxels);
  BoundBlocks bounds = build_bounds(SpherePolicy::kTight, centres, voxels, octree);
  TreeParts parts;
  parts.voxels = TreeVoxels{voxels.lattice, octree, std::move(voxels.normals), std::move(bounds)};
  parts.orientation = tree.orientation();
  return tree_from(std::move(parts));
}

}  // namespace ist
