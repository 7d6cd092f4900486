#include "ist/mesh/format/placed_meshes.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "ist/mesh/format/affine.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {

void PlacedMeshes::expect(std::size_t elements, std::string_view place) {
  // One more, so that a placement of nothing counts as well.
  if (elements >= kMost - expected_)
    fail_mesh(ErrorCode::kMeshTooLarge, file_, place,
              fmt::format("the scene places more than {} vertices and triangles; export each mesh "
                          "to a file of its own",
                          kMost));
  expected_ += elements + 1;
}

void PlacedMeshes::add(const TriangleMesh& mesh, const Eigen::Affine3d& transform,
                       std::string_view place) {
  constexpr std::uint32_t kUnplaced = std::numeric_limits<std::uint32_t>::max();
  const bool mirrors = transform.linear().determinant() < 0;
  std::vector<std::uint32_t> vertex_of(mesh.vertices.size(), kUnplaced);
  const auto placed = [&](std::uint32_t corner) {
    std::uint32_t& vertex = vertex_of[corner];
    if (vertex != kUnplaced) return vertex;
    const Eigen::Vector3d point = moved_by(transform, mesh.vertices[corner]);
    for (const double coordinate : point)
      if (!is_coordinate(coordinate))
        fail_mesh(ErrorCode::kMeshNotFinite, file_, place,
                  fmt::format("vertex {} is not finite, or is placed beyond a float's range; "
                              "repair the mesh where it was made",
                              corner));
    return vertex = builder_.vertex_at(point);
  };
  for (Triangle triangle : mesh.triangles) {
    if (mirrors) std::swap(triangle[1], triangle[2]);
    for (std::uint32_t& corner : triangle) corner = placed(corner);
    builder_.add_face(triangle);
  }
  vertices_ += mesh.vertices.size();
  triangles_ += mesh.triangles.size();
}

TriangleMesh PlacedMeshes::finish() {
  if (triangles_ == 0 && vertices_ == 0)
    fail_mesh(ErrorCode::kMeshEmpty, file_, "", "the scene has no mesh; export the mesh again");
  if (triangles_ == 0)
    fail_mesh(ErrorCode::kMeshPointsOnly, file_, "",
              fmt::format("the scene has {} vertices, but no triangle; export the surface as "
                          "polygons",
                          vertices_));
  return builder_.finish();
}

}  // namespace ist
