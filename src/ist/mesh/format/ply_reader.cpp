#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <vector>

#include "ist/base/counted.h"
#include "ist/mesh/format/mesh_builder.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/ply_body.h"
#include "ist/mesh/format/ply_header.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

template <class Body>
std::uint32_t checked_corner(const Body& body, std::int64_t corner, std::uint64_t vertices) {
  if (corner < 0 || static_cast<std::uint64_t>(corner) >= vertices)
    body.fail(ErrorCode::kMeshBadIndex,
              fmt::format("a face names vertex {}, but there are {}, counted from 0; export the "
                          "mesh again",
                          corner, vertices));
  return static_cast<std::uint32_t>(corner);
}

template <class Body>
void read_corners(Body& body, std::int64_t count, const PlyProperty& property,
                  std::uint64_t vertices, std::vector<std::uint32_t>& corners) {
  require_face_size(count, body);
  corners.clear();
  for (std::int64_t i = 0; i < count; ++i) {
    corners.push_back(checked_corner(body, body.integer(property.type), vertices));
  }
}

// Adds a triangle for each corner after the second one of a strip; every other one is turned. A
// strip repeats corners to go on elsewhere: triangles that have a corner twice are left out.
template <class Body>
void read_strips(Body& body, std::int64_t count, const PlyProperty& property,
                 std::uint64_t vertices, IndexedFaces& surface) {
  if (count < 0)
    body.fail(ErrorCode::kNotAMesh,
              fmt::format("a strip has {} corners; export the mesh again", count));
  std::array<std::uint32_t, 2> last{};
  std::size_t length = 0;  // of the strip so far
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t named = body.integer(property.type);
    if (named == -1) {
      length = 0;
      continue;
    }
    const std::uint32_t corner = checked_corner(body, named, vertices);
    const bool is_triangle =
        length >= 2 && last[0] != last[1] && corner != last[0] && corner != last[1];
    if (is_triangle && length % 2 == 0) surface.add_face(Triangle{last[0], last[1], corner});
    if (is_triangle && length % 2 == 1) surface.add_face(Triangle{last[1], last[0], corner});
    last = {last[1], corner};
    ++length;
  }
}

// Reads one vertex, face or other element; keeps coordinates and corners.
template <class Body>
void read_instance(Body& body, const PlyElement& element, std::uint64_t vertices,
                   std::vector<std::uint32_t>& corners, IndexedFaces& surface) {
  Eigen::Vector3d vertex = Eigen::Vector3d::Zero();
  for (const PlyProperty& property : element.properties) {
    if (property.role == PlyRole::kCorners && element.name == kPlyStrips) {
      read_strips(body, body.integer(property.count_type), property, vertices, surface);
    } else if (property.role == PlyRole::kCorners) {
      read_corners(body, body.integer(property.count_type), property, vertices, corners);
    } else if (property.role == PlyRole::kOther) {
      const std::int64_t count = property.count_type ? body.integer(property.count_type) : 1;
      for (std::int64_t i = 0; i < count; ++i) body.skip(property.type);
    } else {
      vertex[static_cast<Eigen::Index>(property.role)] = body.coordinate(property.type);
    }
  }
  if (element.name == "vertex") surface.add_vertex(vertex);
  if (element.name == "face") surface.add_face(corners);
}

template <class Body>
TriangleMesh read_elements(Body body, const PlyHeader& header, std::string_view file) {
  std::uint64_t vertices = 0;
  for (const PlyElement& element : header.elements)
    if (element.name == "vertex") vertices = element.count;
  IndexedFaces surface;
  std::vector<std::uint32_t> corners;
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty()) continue;  // takes no bytes in the file, for any count
    for (std::uint64_t i = 0; i < element.count; ++i) {
      body.begin(element, i);
      read_instance(body, element, vertices, corners, surface);
      body.end();
    }
  }
  body.finish();
  if (surface.faces() == 0 && surface.vertices() == 0)
    fail_mesh(ErrorCode::kMeshEmpty, file, "", "the PLY has no vertex; export the mesh again");
  if (surface.faces() == 0)
    fail_mesh(ErrorCode::kMeshPointsOnly, file, "",
              fmt::format("the file has {}, but no face; export the surface as polygons",
                          counted(surface.vertices(), "vertex", "vertices")));
  TriangleMesh mesh = surface.weld();
  mesh.frame = header.frame;
  return mesh;
}

}  // namespace

TriangleMesh read_ply(std::string_view content, std::string_view file) {
  TextReader reader(content, file);
  const PlyHeader header = read_ply_header(reader);
  return with_ply_body(reader, header, content, file,
                       [&](auto body) { return read_elements(body, header, file); });
}

}  // namespace ist
