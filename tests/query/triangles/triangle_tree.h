#pragma once

#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"

namespace ist::test {

/// A tree with its triangles.
[[nodiscard]] inline SphereTree tree_with_triangles(const TriangleMesh& mesh, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.keep_triangles = true;
  return build_tree(mesh, options);
}

/// A tree with its triangles, of about `cells` voxels along the mesh's largest extent.
[[nodiscard]] inline SphereTree triangle_tree(const TriangleMesh& mesh, double cells) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
  return tree_with_triangles(mesh, box.sizes().maxCoeff() / cells);
}

/// Each pair of two bodies, with voxels and without them.
template <class Ask>
void for_voxels_or_none(const TriangleMesh& fixed, const TriangleMesh& moving, double voxel_size,
                        const Ask& ask) {
  const SphereTree fixed_trees[] = {tree_with_triangles(fixed, voxel_size), build_tree(fixed)},
                   moving_trees[] = {tree_with_triangles(moving, voxel_size), build_tree(moving)};
  for (const SphereTree& a : fixed_trees) {
    for (const SphereTree& b : moving_trees) ask(a, b);
  }
}

/// The same tree without its triangles: as it would have been built.
[[nodiscard]] inline SphereTree without_triangles(const SphereTree& tree) {
  const TreeVoxels& voxels = voxels_of(tree);
  return tree_from({TreeVoxels{voxels.lattice, voxels.octree, voxels.normals, voxels.bounds},
                    std::nullopt, tree.orientation()});
}

}  // namespace ist::test
