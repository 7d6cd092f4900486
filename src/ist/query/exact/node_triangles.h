#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/exact/triangle_bounds.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

namespace ist {

/// The triangles in each node of one level of a tree, each once. Leaves are often smaller than
/// triangles, so that two triangles are near each other in many pairs of leaves; this level is the
/// finest above the leaves at which a triangle lies in few nodes.
///
/// Triangles are renumbered in the order of the nodes that they first lie in, so that neighbours
/// are close in memory.
///
/// Where voxels are much larger than triangles a node has many, and all pairs of them are tested:
/// for exact queries voxels should be about as large as triangles, or smaller.
class NodeTriangles {
 public:
  /// Makes the lists. The tree must have triangles. Memory: some 120 bytes a triangle.
  explicit NodeTriangles(const SphereTree& tree);

  [[nodiscard]] int level() const noexcept { return level_; }
  /// Returns the cube of a node, relative to the lattice's origin() as rounded to double: each
  /// point of a triangle lies in one of the cubes of the nodes that list the triangle.
  [[nodiscard]] FloatBox cube(std::uint32_t node) const noexcept;
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::uint32_t node) const noexcept {
    return lists_[node];
  }

  [[nodiscard]] std::uint32_t count() const noexcept {
    return static_cast<std::uint32_t>(indices_.size());
  }
  /// Returns the corners of a triangle, mesh coordinates.
  [[nodiscard]] const TriangleCorners& corners(std::uint32_t triangle) const noexcept {
    return corners_[triangle];
  }
  /// Returns the index of a triangle in the mesh.
  [[nodiscard]] std::uint32_t index(std::uint32_t triangle) const noexcept {
    return indices_[triangle];
  }

  [[nodiscard]] std::size_t bytes() const noexcept {
    return (lists_.first.size() + lists_.ids.size() + indices_.size()) * sizeof(std::uint32_t) +
           corners_.size() * sizeof(TriangleCorners);
  }

 private:
  int level_ = 0;
  TriangleLists lists_;
  std::vector<std::uint32_t> indices_;
  std::vector<TriangleCorners> corners_;
  std::span<const OctreeNode> nodes_;
  double voxel_size_, half_edge_;  // half_edge_ includes the pad of the build and rounding
};

}  // namespace ist
