#pragma once

#include <cstdint>
#include <vector>

#include "ist/mesh/triangle_mesh.h"
#include "ist/voxel/lattice.h"
#include "ist/voxel/triangle_box.h"
#include "ist/voxel/voxel_set.h"

namespace ist {

/// A mesh in lattice units, moved by `offset` cells along each axis.
class LatticeMesh {
 public:
  LatticeMesh(const TriangleMesh& mesh, const Lattice& lattice, double offset = 0);

  [[nodiscard]] std::size_t triangle_count() const noexcept { return triangles_->size(); }
  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::uint32_t triangle) const noexcept {
    const Triangle& t = (*triangles_)[triangle];
    return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
  }
  [[nodiscard]] TriangleBox box(std::uint32_t triangle) const noexcept {
    const auto [a, b, c] = corners(triangle);
    return {a, b, c};
  }

 private:
  const std::vector<Triangle>* triangles_;  // the mesh's own; it outlives this
  std::vector<Eigen::Vector3d> vertices_;
};

/// Cubes of 16³ voxels, each with the triangles that meet it: the pieces in which voxels are made.
/// A block's voxels are the 4,096 Morton codes that follow `code << 12`.
struct TriangleBins {
  static constexpr int kLevel = 4;
  static constexpr std::uint32_t kEdge = 1u << kLevel;
  static constexpr std::size_t kBlockCells = 1u << 3 * kLevel;
  static constexpr std::size_t kBlocksARange = 16;  ///< that one worker takes at a time

  std::vector<std::uint64_t> codes;  ///< Morton codes of the blocks that hold something, ascending
  TriangleLists triangles;           ///< one list a block
};

/// What `bin_triangles` is expected to need: over all places of the grid, a convex flat piece meets
/// on average (area of its three projections)/s² + (its three extents)/s + 1 cubes of edge s.
///
/// Source: Steiner's formula; L. A. Santaló, Integral Geometry and Geometric Probability, 1976.
[[nodiscard]] double expected_pairs(const TriangleMesh& mesh, double cube_edge);

/// The most triangles that a mesh may have to be sorted into blocks.
inline constexpr std::size_t kMaxTriangles = (std::size_t{1} << 28) - 1;

/// Sorts the triangles of a mesh into blocks; padded and non-strict, as the voxels are.
/// Precondition: at most kMaxTriangles of them. Cost: O(pairs · log pairs).
///
/// @param cells blocks cover this many cells along each axis, from 0
/// @param pad   blocks are grown by this much, in cells
[[nodiscard]] TriangleBins bin_triangles(const LatticeMesh& mesh, std::uint32_t cells, double pad);

}  // namespace ist
