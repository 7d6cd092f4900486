#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/base/progress.h"
#include "ist/mesh/mesh.h"

namespace ist {

/// Returns the indices of triangles, given by three corners each, in an order in which neighbours
/// are close: any 16, 256, 4096 … that follow each other from a multiple of that number on lie in a
/// compact part of the mesh. The triangles are halved along the longest axis of their centres, at a
/// multiple of the largest such number, again and again. Centres are compared as floats. The same
/// on every machine. Cost: 0.12 µs a triangle and core.
[[nodiscard]] std::vector<std::uint32_t> triangle_order(std::span<const Eigen::Vector3d> corners);

/// The branching factor of a tree of clusters, and the triangles in a cluster.
inline constexpr std::uint32_t kClusterWidth = 16;

/// The bounds of sixteen nodes side by side: what is in a node lies in its box, its disc and its
/// ball. All are round the same centre, and rounded outward.
struct alignas(64) NodeBlock {
  float centre[3][kClusterWidth];  ///< multiples of TriangleClusters::grid()
  float half[3][kClusterWidth];    ///< of the box: |p - centre| along each axis
  float normal[3][kClusterWidth];  ///< of the disc: a unit vector, to within rounding
  float offset[kClusterWidth];     ///< of the disc's middle from the centre, along the normal
  float thickness[kClusterWidth];  ///< half of the disc's: |normal · (p - centre) - offset|
  float rim[kClusterWidth];        ///< the disc's radius: from the line through the centre
  float radius[kClusterWidth];     ///< of the ball
};
static_assert(sizeof(NodeBlock) == 832);

/// Sixteen triangles, in a frame of their own: the coordinates of a corner p are
/// axis i · (p - centre), rounded once, where `centre` is the one of the cluster's bounds. Where
/// there are fewer, the last one is repeated.
struct alignas(64) TriangleCluster {
  float corner[3][3][kClusterWidth];  ///< corner, coordinate
  std::uint32_t id[kClusterWidth];    ///< index in the mesh
  /// Unit vectors at right angles, to within the rounding of float; the coordinates are those along
  /// the axes exactly as they are stored.
  float axis[3][3];       ///< coordinate, axis
  float low[3], high[3];  ///< the range of the coordinates
  std::uint32_t zero;     ///< 0: fills the cluster's last bytes
};
static_assert(sizeof(TriangleCluster) == 704);

/// Returns a bit for each lane whose number is at most `limit`, or no number.
[[nodiscard]] inline std::uint32_t lanes_within(const float (&numbers)[kClusterWidth],
                                                float limit) noexcept {
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
    bits |= static_cast<std::uint32_t>(!(numbers[lane] > limit)) << lane;
  }
  return bits;
}

/// The triangles of a mesh in a tree of sixteen-fold nodes, each triangle once. Nodes of level 0
/// are the clusters; node i of level l + 1 has the nodes 16 i … 16 i + 15 of level l below it, as
/// far as these exist. So there are no pointers: all nodes are full but the last one of each level.
/// At least one level stands above the clusters.
///
/// Lengths are in mesh units. Coordinates are those of a frame of the tree's own: the origin given,
/// and the axes along which the mesh spreads, so that the file's axes do not matter.
/// Memory: 48 bytes a triangle. Never changes after it was made.
class TriangleClusters {
 public:
  /// Cost: 0.2 µs a triangle and core. The same on every machine, for any number of threads.
  /// Precondition: the mesh is valid. `progress` may end the call, as Progress says.
  TriangleClusters(const TriangleMesh& mesh, const Eigen::Vector3d& origin,
                   const Progress* progress = nullptr);

  /// Puts clusters together from the arrays of others: the bounds of each level, and the clusters.
  /// Precondition: node_counts() gives their sizes.
  TriangleClusters(std::uint32_t triangles, const Eigen::Vector3d& origin,
                   const Eigen::Matrix3d& axes, double grid,
                   std::vector<std::vector<NodeBlock>> levels,
                   std::vector<TriangleCluster> clusters);

  /// Returns the number of nodes of each level over so many triangles.
  [[nodiscard]] static std::vector<std::uint32_t> node_counts(std::uint32_t triangles);
  /// Returns the number of blocks of so many nodes.
  [[nodiscard]] static constexpr std::uint32_t block_count(std::uint32_t nodes) noexcept {
    return nodes / kClusterWidth + static_cast<std::uint32_t>(nodes % kClusterWidth != 0);
  }

  /// No tree of 32-bit indices has more levels above its clusters.
  static constexpr std::size_t kMostLevels = 8;

  /// The level of the root: 1 or more.
  [[nodiscard]] int root_level() const noexcept { return static_cast<int>(levels_.size()) - 1; }
  [[nodiscard]] std::uint32_t node_count(int level) const noexcept {
    return counts_[static_cast<std::size_t>(level)];
  }
  /// The bounds of the nodes at `level`, in blocks of sixteen: those of one parent. The root has a
  /// block of its own.
  [[nodiscard]] std::span<const NodeBlock> bounds(int level) const noexcept {
    return levels_[static_cast<std::size_t>(level)];
  }
  [[nodiscard]] std::span<const TriangleCluster> clusters() const noexcept { return clusters_; }
  [[nodiscard]] std::uint32_t triangle_count() const noexcept { return triangle_count_; }
  /// The number of nodes, at `level`, below node `parent` of the level above it; of triangles in a
  /// cluster where `level` is -1.
  [[nodiscard]] std::uint32_t child_count(int level, std::uint32_t parent) const noexcept {
    const std::uint32_t all = level < 0 ? triangle_count_ : node_count(level);
    const std::uint32_t rest = all - kClusterWidth * parent;
    return rest < kClusterWidth ? rest : kClusterWidth;
  }

  /// The origin of the tree's frame, in mesh coordinates.
  [[nodiscard]] const Eigen::Vector3d& origin() const noexcept { return origin_; }
  /// The largest coordinate in the tree's frame, or more.
  [[nodiscard]] double extent() const noexcept {
    const NodeBlock& root = bounds(root_level())[0];
    double extent = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      extent = std::max(extent, std::abs(double{root.centre[i][0]}) + double{root.half[i][0]});
    }
    return extent;
  }
  /// The axes of the tree's frame: the columns of an orthogonal matrix, in mesh coordinates.
  [[nodiscard]] const Eigen::Matrix3d& axes() const noexcept { return axes_; }
  /// A power of two. Coordinates of centres are whole multiples of it, no more than 2^22 of them:
  /// so the difference of two is a float.
  [[nodiscard]] double grid() const noexcept { return grid_; }

  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  Eigen::Vector3d origin_;
  Eigen::Matrix3d axes_;
  double grid_;
  std::uint32_t triangle_count_;
  std::vector<std::uint32_t> counts_;  // nodes of each level
  std::vector<std::vector<NodeBlock>> levels_;
  std::vector<TriangleCluster> clusters_;
};

}  // namespace ist
