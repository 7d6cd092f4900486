#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/exact/triangle_bounds.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// The triangles that are in each node of one level of a tree, each once. Leaves are often smaller
/// than triangles, so that two triangles are near each other in many pairs of leaves; here the
/// level is the finest, of those above the leaves, at which a triangle is in no more than a few
/// nodes.
///
/// Triangles are numbered anew, in the order of the nodes that they are in first: so those that are
/// near each other are so in memory too.
///
/// Where voxels are much larger than triangles a node has many, and each is held against each: a
/// tree that is asked about its triangles should have voxels of about their size, or smaller.
class NodeTriangles {
 public:
  /// The tree must have triangles. Memory: some 120 bytes a triangle.
  explicit NodeTriangles(const SphereTree& tree);

  [[nodiscard]] int level() const noexcept { return level_; }
  /// The cube of a node, from the lattice's origin() as it is rounded to double: a point of a
  /// triangle is in one of the cubes of the nodes that have the triangle.
  [[nodiscard]] FloatBox cube(std::uint32_t node) const noexcept;
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::uint32_t node) const noexcept {
    return lists_[node];
  }

  [[nodiscard]] std::uint32_t count() const noexcept {
    return static_cast<std::uint32_t>(indices_.size());
  }
  /// Of a triangle, mesh frame.
  [[nodiscard]] const TriangleCorners& corners(std::uint32_t triangle) const noexcept {
    return corners_[triangle];
  }
  /// What the mesh calls it.
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
  double voxel_size_, half_edge_;  // of a cube, grown by the pad of the build and by rounding
};

}  // namespace ist
