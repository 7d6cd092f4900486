#include "ist/mesh/format/mesh_builder.h"

#include <bit>
#include <limits>
#include <utility>

#include "ist/base/assert.h"
#include "ist/base/cancellation.h"
#include "ist/base/platform/bit_cast.h"
#include "ist/mesh/format/triangulate.h"

namespace ist {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

std::size_t hash_of(const Eigen::Vector3d& point) {
  std::uint64_t hash = 0;
  for (const double coordinate : point) {
    hash = (hash ^ bit_cast<std::uint64_t>(coordinate)) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 32;
  }
  return hash;
}

}  // namespace

MeshBuilder::MeshBuilder(std::size_t triangles) {
  mesh_.triangles.reserve(triangles);
  const std::size_t vertices = triangles / 2 + 2;  // of a closed surface without handles
  mesh_.vertices.reserve(vertices);
  slots_.assign(std::bit_ceil(vertices + vertices / 2), kNoVertex);
}

std::uint32_t MeshBuilder::vertex_at(const Eigen::Vector3d& given) {
  const Eigen::Vector3d point = given.array() + 0.0;  // turns -0 into 0
  const std::size_t slot = slot_of(point);
  if (slots_[slot] != kNoVertex) return slots_[slot];
  IST_ASSERT(mesh_.vertices.size() < kNoVertex);
  const auto vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
  slots_[slot] = vertex;
  mesh_.vertices.push_back(point);
  if (4 * mesh_.vertices.size() > 3 * slots_.size()) double_slots();
  return vertex;
}

void MeshBuilder::add_face(std::span<const std::uint32_t> corners) {
  cancellation_point();
  triangulate(corners, mesh_.vertices, mesh_.triangles);
}

TriangleMesh MeshBuilder::finish() { return std::exchange(mesh_, {}); }

// Returns the slot that holds the vertex at a point, or the empty slot where it belongs.
std::size_t MeshBuilder::slot_of(const Eigen::Vector3d& point) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(point) & mask;
  while (slots_[slot] != kNoVertex && mesh_.vertices[slots_[slot]] != point)
    slot = (slot + 1) & mask;
  return slot;
}

void MeshBuilder::double_slots() {
  const std::size_t size = 2 * slots_.size();
  slots_ = {};  // freed first
  slots_.assign(size, kNoVertex);
  for (std::size_t i = 0; i < mesh_.vertices.size(); ++i)
    slots_[slot_of(mesh_.vertices[i])] = static_cast<std::uint32_t>(i);
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
  std::vector<std::uint32_t> vertex_of(points_.size(), kNoVertex);
  std::vector<std::uint32_t> polygon;
  for (std::size_t at = 0; at < corners_.size(); at += polygon.size() + 1) {
    polygon.assign(&corners_[at] + 1, &corners_[at] + 1 + corners_[at]);
    for (std::uint32_t& corner : polygon) {
      std::uint32_t& vertex = vertex_of[corner];
      if (vertex == kNoVertex) vertex = builder.vertex_at(points_[corner]);
      corner = vertex;
    }
    builder.add_face(polygon);
  }
  return builder.finish();
}

}  // namespace ist
