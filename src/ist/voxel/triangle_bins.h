#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/voxel/lattice.h"
#include "ist/voxel/voxel_set.h"

namespace ist {

/// A triangle prepared for intersection tests against many axis-aligned cubes.
///
/// Separating axis test: a cube and the triangle are disjoint exactly if one of 13 axes separates
/// their projections: the three cube axes, the triangle's normal, and the nine cross products of a
/// cube axis and an edge. All tests are non-strict: a common boundary point counts. Rounding errors
/// stay below 1e-13 of the coordinates' range, so a cube padded by more loses no intersection.
/// Slivers are no exception: edges are exact to their own length, and the normal is computed in
/// twice the precision.
///
/// Cost: 120 flops to construct, 10 to 60 a cube.
/// Source: T. Akenine-Möller, Fast 3D triangle-box overlap testing, J. Graphics Tools 6(1), 2001;
/// terms of the triangle alone precomputed as in M. Schwarz, H.-P. Seidel, Fast parallel surface
/// and solid voxelization on GPUs, SIGGRAPH Asia 2010.
class TriangleBox {
 public:
  TriangleBox(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
              const Eigen::Vector3d& c) noexcept;

  [[nodiscard]] const Eigen::Vector3d& min() const noexcept { return min_; }
  [[nodiscard]] const Eigen::Vector3d& max() const noexcept { return max_; }

  /// Whether the closed cube of half edge `half` round (x, y, z) intersects the triangle.
  [[nodiscard]] bool meets(double x, double y, double z, double half) const noexcept {
    return x + half >= min_[0] && x - half <= max_[0] && y + half >= min_[1] &&
           y - half <= max_[1] && z + half >= min_[2] && z - half <= max_[2] &&
           meets_within_bounds(x, y, z, half);
  }

  /// Tests a cube that is known to overlap the triangle's bounding box.
  [[nodiscard]] bool meets_within_bounds(double x, double y, double z, double half) const noexcept {
    return meets_column(x, y, half) && meets_in_column(x, y, z, half);
  }
  /// Makes the tests that the cubes over one (x, y) share.
  [[nodiscard]] bool meets_column(double x, double y, double half) const noexcept {
    const double px = x - origin_[0], py = y - origin_[1];
    for (const EdgeAxes& e : edges_) {
      if (e.z.separates(px, py, half)) return false;
    }
    return true;
  }
  /// Makes the other tests.
  [[nodiscard]] bool meets_in_column(double x, double y, double z, double half) const noexcept {
    const double px = x - origin_[0], py = y - origin_[1], pz = z - origin_[2];
    const double height = (normal_[0] * px + normal_[1] * py) + normal_[2] * pz;
    if (height > half * normal_reach_ || -height > half * normal_reach_) return false;
    for (const EdgeAxes& e : edges_) {
      if (e.x.separates(py, pz, half) || e.y.separates(pz, px, half)) return false;
    }
    return true;
  }

 private:
  // The cross product of an edge and a cube axis has only the other two coordinates: p·u + q·v. The
  // triangle projects to [low, high]; a cube to its centre ± half · reach.
  struct Axis {
    double u, v, low, high, reach;
    [[nodiscard]] bool separates(double p, double q, double half) const noexcept {
      const double centre = u * p + v * q, radius = half * reach;
      return centre + radius < low || centre - radius > high;
    }
  };
  struct EdgeAxes {
    Axis x, y, z;
  };

  Eigen::Vector3d origin_, min_, max_;
  Eigen::Vector3d normal_;  // not of unit length
  double normal_reach_;
  EdgeAxes edges_[3];
};

/// A mesh in lattice units, shifted by `offset` cells along each axis.
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
  const std::vector<Triangle>* triangles_;  // of the mesh, which must outlive this object
  std::vector<Eigen::Vector3d> vertices_;
};

/// Blocks of 16³ voxels, each with the triangles that intersect it: the work items of the
/// voxelization. A block's voxels have the 4,096 Morton codes from `code << 12` on.
struct TriangleBins {
  static constexpr int kLevel = 4;
  static constexpr std::uint32_t kEdge = 1u << kLevel;
  static constexpr std::size_t kBlockCells = 1u << 3 * kLevel;
  static constexpr std::size_t kBlocksARange = 16;  ///< blocks of one parallel range

  std::vector<std::uint64_t> codes;  ///< Morton codes of the non-empty blocks, ascending
  TriangleLists triangles;           ///< one list a block
};

/// Calls visit(x, y, z) for each cell of a block whose indices are in [low, high], in order of x,
/// then y, then z, if enter(x, y) is true.
template <typename Enter, typename Visit>
void for_each_cell(const Cell& block, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                   const Enter& enter, const Visit& visit) {
  Cell first, last;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const double begin = block[i] * TriangleBins::kEdge;
    const double from = std::max(begin, std::ceil(low[axis]));
    const double to = std::min(begin + TriangleBins::kEdge - 1, std::floor(high[axis]));
    if (from > to) return;
    first[i] = static_cast<std::uint32_t>(from);
    last[i] = static_cast<std::uint32_t>(to);
  }
  for (std::uint32_t x = first[0]; x <= last[0]; ++x) {
    for (std::uint32_t y = first[1]; y <= last[1]; ++y) {
      if (!enter(x, y)) continue;
      for (std::uint32_t z = first[2]; z <= last[2]; ++z) visit(x, y, z);
    }
  }
}

/// Counts pairs of triangle and cube on a grid of any size, without a look for them.
///
/// Source: Steiner's formula; L. A. Santaló, Integral Geometry and Geometric Probability, 1976.
class PairCounts {
 public:
  /// Cost: 5 ns a triangle.
  explicit PairCounts(const TriangleMesh& mesh) noexcept;

  /// Returns the number to expect. Averaged over all positions of the grid, a convex flat polygon
  /// intersects (area of its three projections)/s² + (its three extents)/s + 1 cubes of edge s.
  [[nodiscard]] double expected(double edge) const noexcept {
    return projections_ / (edge * edge) + extents_ / edge + triangles_;
  }
  /// Returns the least number for any position of the grid. A plane has at most an area of √2 s² in
  /// a cube of edge s, and a cube covers s² of a projection along an axis.
  [[nodiscard]] double least(double edge) const noexcept {
    return std::max(triangles_, (1 - 1e-3) * sections_ / (edge * edge));
  }

 private:
  double projections_ = 0, extents_ = 0, sections_ = 0, triangles_ = 0;
};

/// The largest number of triangles of a mesh that bin_triangles accepts.
inline constexpr std::size_t kMaxTriangles = (std::size_t{1} << 28) - 1;

/// Sorts the triangles of a mesh into blocks; blocks are padded and closed, as voxels are.
/// Precondition: at most kMaxTriangles triangles.
/// Cost: O(pairs · log pairs).
///
/// @param cells blocks cover this many cells along each axis, from 0
/// @param pad   blocks are grown by this much, in cells
[[nodiscard]] TriangleBins bin_triangles(const LatticeMesh& mesh, std::uint32_t cells, double pad);

}  // namespace ist
