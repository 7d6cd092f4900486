#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ist/mesh/components.h"
#include "ist/mesh/mesh.h"
#include "ist/mesh/nearest_point.h"

namespace ist {

/// The normals that tell on which side of a surface a point lies: those of the faces, of an edge
/// the sum of both faces', of a vertex that of all its faces', weighted by their angles. A point
/// lies outside where the way to it from its nearest point has a component along the normal there.
///
/// Triangles without an area have no normal: over them the neighbours beyond count, and vertices at
/// one position that they join count as one.
/// Source: J. A. Baerentzen, H. Aanaes, Signed distance computation using the angle weighted
/// pseudonormal, IEEE Transactions on Visualization and Computer Graphics 11(3), 2005.
class Pseudonormals {
 public:
  /// Memory: 12 bytes a triangle and 24 a vertex. Cost: 0.2 µs a triangle.
  explicit Pseudonormals(const TriangleMesh& mesh);

  /// Returns the normal at a point of a triangle of the same mesh, not of unit length. Returns
  /// nothing where the point lies on an edge that is open, or that other than two triangles share,
  /// once each way; at a vertex of such an edge; and where there is no normal.
  [[nodiscard]] std::optional<Eigen::Vector3d> at(const TriangleMesh& mesh, std::uint32_t triangle,
                                                  const NearestPoint& on) const noexcept;

  /// Returns whether as many triangles traverse each edge one way as the other.
  [[nodiscard]] bool closed() const noexcept { return closed_; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::vector<bool> join_neighbours(const TriangleMesh& mesh, std::span<const EdgeUse> uses);
  void add_angles(const TriangleMesh& mesh, std::uint32_t triangle, DisjointSets& places);
  [[nodiscard]] std::optional<Eigen::Vector3d> at_edge_below(const TriangleMesh& mesh,
                                                             std::uint32_t triangle,
                                                             const NearestPoint& on) const noexcept;
  [[nodiscard]] Eigen::Vector3d beyond(const TriangleMesh& mesh, std::uint32_t triangle,
                                       std::uint32_t from,
                                       const Eigen::Vector3d& at) const noexcept;

  std::vector<std::array<std::uint32_t, 3>> across_;  // each edge of a triangle: the neighbour
  std::vector<Eigen::Vector3d> of_vertex_;            // zero where it is unknown
  bool closed_ = true;
};

}  // namespace ist
