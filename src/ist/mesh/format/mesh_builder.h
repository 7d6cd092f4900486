#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "ist/mesh/weld.h"

namespace ist {

/// Builds a mesh from the faces of a file. Points with exactly equal coordinates become one vertex;
/// -0 equals 0. Vertices are in the order of their first use, triangles in the order of the faces.
class MeshBuilder {
 public:
  /// Reserves memory for a closed surface of so many triangles; there may be more or fewer.
  explicit MeshBuilder(std::size_t triangles);

  /// Returns the vertex at a point. Precondition: the point is finite. Cost: O(1) on average.
  [[nodiscard]] std::uint32_t vertex_at(const Eigen::Vector3d& point);
  /// Adds a face of three or more vertices, triangulated.
  void add_face(std::span<const std::uint32_t> corners);
  /// Returns the mesh and leaves this object empty.
  [[nodiscard]] TriangleMesh finish();

 private:
  void make_room();

  TriangleMesh mesh_;
  PositionTable places_;
};

/// The largest number of corners of a face; a face with more is refused, because triangulation is
/// quadratic or worse.
inline constexpr std::int64_t kMaxCorners = 1024;

/// Throws kNotAMesh through `reader` for a face of fewer than three or too many corners.
template <class Reader>
void require_face_size(std::int64_t corners, const Reader& reader) {
  if (corners < 3)
    reader.fail(ErrorCode::kNotAMesh, fmt::format("a face has {} corners, and needs three; export "
                                                  "the mesh again",
                                                  corners));
  if (corners > kMaxCorners)
    reader.fail(ErrorCode::kNotAMesh,
                fmt::format("a face has {} corners, more than {}; triangulate the mesh first",
                            corners, kMaxCorners));
}

/// Collects a file's vertices and faces, which name vertices by index, in any order.
class IndexedFaces {
 public:
  void add_vertex(const Eigen::Vector3d& point);
  void add_face(std::span<const std::uint32_t> corners);
  [[nodiscard]] std::size_t vertices() const { return points_.size(); }
  [[nodiscard]] std::size_t faces() const { return faces_; }
  /// Whether both hold the same vertices and faces, in the same order.
  [[nodiscard]] bool operator==(const IndexedFaces&) const = default;
  /// Builds the mesh of all faces. Precondition: each corner is an index of a vertex.
  [[nodiscard]] TriangleMesh weld() const;

 private:
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::uint32_t> corners_;  // of each face: their number, then their indices
  std::size_t faces_ = 0;
};

}  // namespace ist
