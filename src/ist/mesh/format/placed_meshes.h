#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ist/mesh/format/mesh_builder.h"
#include "ist/mesh/mesh.h"

namespace ist {

/// Joins the meshes of a scene to one surface, each where a transform places it. A few bytes of a
/// file can place a mesh many times; so the surface has a limit.
class PlacedMeshes {
 public:
  /// The most vertices and triangles that are placed, repetitions included: a mesh of some 2 GiB.
  static constexpr std::size_t kMost = std::size_t{1} << 25;

  /// `file` is named in errors.
  explicit PlacedMeshes(std::string_view file) : file_(file) {}

  /// Adds the triangles of `mesh`, whose vertices need not be welded. A transform that mirrors
  /// turns the winding round, so that the outer side stays outside. Each index must be of a vertex.
  /// Errors, with `place`: kMeshTooLarge; kMeshNotFinite for a vertex that is placed beyond the
  /// range of a float.
  void add(const TriangleMesh& mesh, const Eigen::Affine3d& transform, std::string_view place);
  /// Counts a placement of so many vertices and triangles, before they are read.
  /// Errors: kMeshTooLarge.
  void expect(std::size_t elements, std::string_view place);

  /// Returns the surface. Errors: kMeshEmpty and kMeshPointsOnly, where no triangle was added.
  [[nodiscard]] TriangleMesh finish();

 private:
  std::string_view file_;
  MeshBuilder builder_{0};
  std::size_t expected_ = 0, triangles_ = 0, vertices_ = 0;
};

}  // namespace ist
