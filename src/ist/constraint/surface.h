#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ist/base/api.h"
#include "ist/mesh/mesh.h"
#include "ist/query/results.h"

namespace ist {

/// A vertex, an edge or a triangle of a mesh, by its index.
struct SurfacePart {
  enum class Kind : std::uint8_t { kVertex, kEdge, kFace };
  Kind kind;
  std::uint32_t index;

  friend bool operator==(const SurfacePart&, const SurfacePart&) = default;
};

/// The vertices and edges of a mesh with their neighbours. Vertices at one position count as one.
/// Refers to the mesh. Memory: some 70 bytes a triangle. Cost: 0.3 µs a triangle.
class IST_LOOP_API Surface {
 public:
  explicit Surface(const TriangleMesh& mesh);

  [[nodiscard]] const TriangleMesh& mesh() const noexcept { return mesh_; }
  /// Returns the part of the mesh that a part of a triangle belongs to.
  [[nodiscard]] SurfacePart part(std::uint32_t triangle, TrianglePart part) const noexcept;
  /// Returns whether a vertex or an edge lies inside a plane region. Its triangles then describe
  /// the surface without it.
  [[nodiscard]] bool is_flat(const SurfacePart& part) const noexcept;
  /// Returns whether a direction leaves the surface at a part: no triangle at the part ascends
  /// along the direction by more than `tolerance`, the sine of an angle. A point that is away from
  /// the part in such a direction has no closer point nearby. A triangle itself never blocks. Cost:
  /// 5 ns a neighbour.
  /// @param direction of unit length, mesh coordinates
  [[nodiscard]] bool leaves(const SurfacePart& part, const Eigen::Vector3d& direction,
                            double tolerance) const noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  // Lists of indices, one for each vertex or edge.
  struct Lists {
    std::vector<std::uint32_t> begin, items;
  };

  [[nodiscard]] Eigen::Vector3d across(std::uint32_t edge, std::uint32_t opposite) const noexcept;
  void find_edges();
  void find_flat_parts();

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> first_;                 // vertex at the position of a vertex
  std::vector<std::array<std::uint32_t, 3>> edges_;  // of a triangle, as TrianglePart counts
  std::vector<std::array<std::uint32_t, 2>> ends_;   // of an edge, the lower vertex first
  Lists opposite_;                                   // of an edge: third corners
  Lists neighbours_;                                 // of a vertex: other ends of its edges
  std::vector<bool> flat_vertices_, flat_edges_;
};

}  // namespace ist
