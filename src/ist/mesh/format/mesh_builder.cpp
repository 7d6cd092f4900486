#include "ist/mesh/format/mesh_builder.h"

#include <limits>
#include <utility>

#include "ist/base/assert.h"
#include "ist/base/cancellation.h"
#include "ist/mesh/format/part_diagonals.h"
#include "ist/mesh/format/triangulate.h"

namespace ist {
MeshBuilder::MeshBuilder(std::size_t triangles) {
  mesh_.triangles.reserve(triangles);
  const std::size_t vertices = triangles / 2 + 2;  // of a closed surface without handles
  mesh_.vertices.reserve(vertices);
  places_.reset(vertices);
}

std::uint32_t MeshBuilder::vertex_at(const Eigen::Vector3d& given) {
  const Eigen::Vector3d point = given.array() + 0.0;  // turns -0 into 0
  std::uint32_t& slot = places_.slot_of(point, mesh_.vertices);
  if (slot != PositionTable::kNoVertex) return slot;
  IST_ASSERT(mesh_.vertices.size() < PositionTable::kNoVertex);
  const auto vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
  slot = vertex;
  mesh_.vertices.push_back(point);
  if (mesh_.vertices.size() > places_.room()) make_room();
  return vertex;
}

void MeshBuilder::add_face(std::span<const std::uint32_t> corners) {
  cancellation_point();
  triangulate(corners, mesh_.vertices, mesh_.triangles);
}

TriangleMesh MeshBuilder::finish() { return std::exchange(mesh_, {}); }

void MeshBuilder::make_room() {
  places_.reset(places_.room() + 1);
  for (std::size_t i = 0; i < mesh_.vertices.size(); ++i) {
    places_.slot_of(mesh_.vertices[i], mesh_.vertices) = static_cast<std::uint32_t>(i);
  }
}

void IndexedFaces::add_vertex(const Eigen::Vector3d& point) {
  cancellation_point();
  points_.push_back(point);
}

void IndexedFaces::add_face(std::span<const std::uint32_t> corners) {
  cancellation_point();
  corners_.push_back(static_cast<std::uint32_t>(corners.size()));
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  ++faces_;
}

TriangleMesh IndexedFaces::weld() const {
  // A face of n corners becomes n - 2 triangles, and takes n + 1 entries.
  MeshBuilder builder(corners_.size() - 3 * faces_);
  std::vector<std::uint32_t> vertex_of(points_.size(), PositionTable::kNoVertex);
  std::vector<std::uint32_t> polygon;
  for (std::size_t at = 0; at < corners_.size(); at += polygon.size() + 1) {
    polygon.assign(&corners_[at] + 1, &corners_[at] + 1 + corners_[at]);
    for (std::uint32_t& corner : polygon) {
      std::uint32_t& vertex = vertex_of[corner];
      if (vertex == PositionTable::kNoVertex) vertex = builder.vertex_at(points_[corner]);
      corner = vertex;
    }
    builder.add_face(polygon);
  }
  TriangleMesh mesh = builder.finish();
  if (corners_.size() == 4 * faces_) return mesh;  // triangles
  std::vector<std::uint32_t> polygons = corners_;
  for (std::size_t at = 0; at < polygons.size(); at += polygons[at] + 1) {
    for (std::size_t i = 1; i <= polygons[at]; ++i) polygons[at + i] = vertex_of[polygons[at + i]];
  }
  part_diagonals(polygons, mesh);
  return mesh;
}

}  // namespace ist
