#include "ist/mesh/format/mesh_builder.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include "ist/base/assert.h"
#include "ist/base/cancellation.h"
#include "ist/mesh/format/triangulate.h"

namespace ist {
namespace {

using PolygonCorners = std::span<const std::uint32_t>;

std::uint64_t edge(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

std::array<std::uint64_t, 3> edges_of(const Triangle& t) {
  return {edge(t[0], t[1]), edge(t[1], t[2]), edge(t[2], t[0])};
}

// The sides of a polygon, to look up.
class Sides {
 public:
  void take(const PolygonCorners& polygon) {
    sides_.clear();
    std::uint32_t last = polygon.back();
    for (const std::uint32_t corner : polygon) {
      sides_.push_back(edge(last, corner));
      last = corner;
    }
    std::sort(sides_.begin(), sides_.end());
  }
  [[nodiscard]] bool hold(std::uint64_t of) const {
    return std::binary_search(sides_.begin(), sides_.end(), of);
  }

 private:
  std::vector<std::uint64_t> sides_;
};

// How many sides of triangles an edge is.
class EdgeUses {
 public:
  explicit EdgeUses(const std::vector<Triangle>& triangles) {
    edges_.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
      for (const std::uint64_t each : edges_of(t)) edges_.push_back(each);
    }
    std::sort(edges_.begin(), edges_.end());
  }

  [[nodiscard]] bool is_any_above_two() const {
    for (std::size_t i = 2; i < edges_.size(); ++i) {
      if (edges_[i] == edges_[i - 2]) return true;
    }
    return false;
  }
  [[nodiscard]] std::ptrdiff_t of(std::uint64_t each) const {
    const auto [begin, end] = std::equal_range(edges_.begin(), edges_.end(), each);
    const auto change = changes_.find(each);
    return end - begin + (change == changes_.end() ? 0 : change->second);
  }
  void add(std::span<const Triangle> triangles, std::ptrdiff_t times) {
    for (const Triangle& t : triangles) {
      for (const std::uint64_t each : edges_of(t)) changes_[each] += times;
    }
  }

 private:
  std::vector<std::uint64_t> edges_;                           // sorted, each as often as used
  std::unordered_map<std::uint64_t, std::ptrdiff_t> changes_;  // since then
};

bool shares_diagonal(const Sides& sides, std::span<const Triangle> triangles,
                     const EdgeUses& uses) {
  for (const Triangle& t : triangles) {
    for (const std::uint64_t each : edges_of(t)) {
      if (uses.of(each) > 2 && !sides.hold(each)) return true;
    }
  }
  return false;
}

// Triangulates a polygon again if another polygon uses one of its diagonals as an edge. Two quads
// that share opposite corners may have the same diagonal. Then four triangles meet in it, and a
// closed surface has a doubled triangle. Most polygons have another diagonal.
//
// @param polygons for each polygon: its number of corners n, then the corners' vertices in the
// mesh
// @param mesh has n - 2 triangles for each polygon, in order; keeps that order
// Cost: O(t log t) for t triangles, and triangulate_avoiding() for each polygon with such a
// diagonal, at most twice.
void part_diagonals(std::span<const std::uint32_t> polygons, TriangleMesh& mesh) {
  EdgeUses uses(mesh.triangles);
  if (!uses.is_any_above_two()) return;
  std::vector<Triangle> cut;
  Sides sides;
  // A polygon may have no free diagonal until a later one is cut anew.
  for (int round = 0; round < 2; ++round) {
    std::size_t next = 0;
    for (std::size_t at = 0; at < polygons.size(); at += polygons[at] + 1) {
      const PolygonCorners polygon = polygons.subspan(at + 1, polygons[at]);
      const std::span<Triangle> triangles(&mesh.triangles[next], polygon.size() - 2);
      next += triangles.size();
      if (polygon.size() == 3) continue;
      sides.take(polygon);
      if (!shares_diagonal(sides, triangles, uses)) continue;
      cancellation_point();
      uses.add(triangles, -1);
      cut.clear();
      const auto is_free = [&](std::uint32_t a, std::uint32_t b) {
        return uses.of(edge(a, b)) == 0 && !sides.hold(edge(a, b));
      };
      triangulate_avoiding(polygon, mesh.vertices, is_free, cut);
      std::copy(cut.begin(), cut.end(), triangles.begin());
      uses.add(triangles, 1);
    }
  }
}

}  // namespace

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
