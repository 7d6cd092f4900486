#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "ist/base/cancellation.h"
#include "ist/base/counted.h"
#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/bounding_box.h"
#include "ist/mesh/components.h"
#include "ist/mesh/mesh.h"
#include "ist/mesh/self_intersections.h"

namespace ist {
namespace {

bool is_degenerate(const TriangleMesh& mesh, const Triangle& triangle) {
  if (has_equal_indices(triangle)) return true;
  Eigen::Vector3d u = mesh.vertices[triangle[1]] - mesh.vertices[triangle[0]];
  Eigen::Vector3d v = mesh.vertices[triangle[2]] - mesh.vertices[triangle[0]];
  // Scaled by the larger extent, so that the fourth powers stay in range for any unit.
  const double extent = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
  if (!(extent > 0)) return true;
  u /= extent;
  v /= extent;
  constexpr double kThinnest = 1e-12;
  const double longest2 =
      std::max({square_in_order(u), square_in_order(v), square_in_order(u - v)});
  return square_in_order(u.cross(v)) <= kThinnest * kThinnest * longest2 * longest2;
}

std::size_t count_duplicates(const TriangleMesh& mesh) {
  std::vector<Triangle> sorted;
  sorted.reserve(mesh.triangles.size());
  for (Triangle triangle : mesh.triangles) {
    if (has_equal_indices(triangle)) continue;
    std::sort(triangle.begin(), triangle.end());
    sorted.push_back(triangle);
  }
  std::sort(sorted.begin(), sorted.end());
  std::size_t duplicates = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) duplicates += sorted[i] == sorted[i - 1];
  return duplicates;
}

void count_edges(std::span<const EdgeUse> uses, MeshReport& report) {
  for_each_edge(uses, [&report](std::span<const EdgeUse> edge) {
    ++report.edges;
    if (edge.size() == 1) ++report.boundary_edges;
    if (edge.size() > 2) ++report.non_manifold_edges;
    if (edge.size() == 2 && !is_balanced(edge)) ++report.inconsistent_edges;
    if (edge.size() % 2 == 0 && !is_balanced(edge)) report.consistent = false;
    if (edge.size() % 2 == 1) report.closed = false;
  });
}

void count_components(const TriangleMesh& mesh, std::span<const EdgeUse> uses, MeshReport& report) {
  DisjointSets sets(mesh.vertices.size());
  for (const EdgeUse& use : uses) sets.join(use.low, use.high);
  std::vector<bool> used(mesh.vertices.size(), false), open(mesh.vertices.size(), false);
  for (const EdgeUse& use : uses) used[sets.find(use.low)] = true;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 1) open[sets.find(edge[0].low)] = true;
  });
  report.components = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  report.open_components = static_cast<std::size_t>(std::count(open.begin(), open.end(), true));
}

Eigen::AlignedBox3d box_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t v : mesh.triangles[triangle]) box.extend(mesh.vertices[v]);
  return box;
}

void add_self_intersections(const TriangleMesh& mesh, MeshReport& report) {
  constexpr std::size_t kListed = 8;
  if (!has_usable_extent(bounding_box(mesh))) {
    report.self_intersections_complete = false;
    return;
  }
  const TriangleClusters clusters(mesh, mesh.vertices[mesh.triangles[0][0]]);
  const SelfIntersections found = find_self_intersections(mesh, clusters);
  const auto& pairs = found.pairs;
  report.self_intersections = pairs.size();
  report.self_intersections_complete = found.complete;
  for (std::size_t k = 0; k < std::min(kListed, pairs.size()); ++k) {
    const Eigen::AlignedBox3d overlap =
        box_of(mesh, pairs[k][0]).intersection(box_of(mesh, pairs[k][1]));
    report.first_self_intersections.push_back({pairs[k], overlap.center()});
  }
}

// Returns the sum of signed tetrahedron volumes (determinants / 6) relative to a vertex of the
// mesh, so that the mesh's distance from the origin adds no rounding error.
double signed_volume(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  const Eigen::Vector3d origin = mesh.vertices[mesh.triangles[0][0]];
  double sixfold = 0;
  for (const Triangle& t : mesh.triangles)
    sixfold += dot_in_order(mesh.vertices[t[0]] - origin,
                            (mesh.vertices[t[1]] - origin).cross(mesh.vertices[t[2]] - origin));
  return sixfold / 6;
}

}  // namespace

void require_valid(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) {
    throw mesh.vertices.empty()
        ? Error(ErrorCode::kMeshEmpty, "the mesh has no vertices and no triangles: pass some")
        : Error(ErrorCode::kMeshPointsOnly,
                fmt::format("the mesh has {}, but no triangles: pass some",
                            counted(mesh.vertices.size(), "vertex", "vertices")));
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d& v = mesh.vertices[i];
    if (!(std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]))) {
      throw_error(ErrorCode::kMeshNotFinite, "vertex {} is ({}, {}, {}): pass finite numbers", i,
                  v[0], v[1], v[2]);
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      if (vertex < mesh.vertices.size()) continue;
      throw_error(ErrorCode::kMeshBadIndex,
                  "triangle {} has the vertex index {}, but there {} {}: count from 0", i, vertex,
                  mesh.vertices.size() == 1 ? "is" : "are",
                  counted(mesh.vertices.size(), "vertex", "vertices"));
    }
  }
}

MeshReport check_mesh(const TriangleMesh& mesh) {
  const ScopedFloatEnvironment environment;
  MeshReport report;
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();
  cancellation_point();
  if (!mesh.triangles.empty()) require_valid(mesh);
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  report.closed = !uses.empty();
  report.consistent = true;
  cancellation_point();
  count_edges(uses, report);
  cancellation_point();
  count_components(mesh, uses, report);
  cancellation_point();
  report.duplicate_triangles = count_duplicates(mesh);
  cancellation_point();
  report.degenerate_triangles = static_cast<std::size_t>(
      std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                    [&mesh](const Triangle& t) { return is_degenerate(mesh, t); }));
  if (!mesh.triangles.empty()) add_self_intersections(mesh, report);
  if (!mesh.vertices.empty()) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
    report.box_min = box.min();
    report.box_max = box.max();
  }
  report.signed_volume = signed_volume(mesh);
  return report;
}

std::vector<std::string> warnings(const MeshReport& report) {
  std::vector<std::string> sentences;
  const auto warn = [&sentences](std::size_t count, std::string_view one, std::string_view many) {
    if (count == 1) sentences.emplace_back(one);
    if (count > 1) sentences.push_back(fmt::format(fmt::runtime(many), count));
  };
  warn(report.boundary_edges,
       "The surface is open: 1 edge belongs to only one triangle. The inside is a guess.",
       "The surface is open: {} edges belong to only one triangle. The inside is a guess.");
  warn(report.non_manifold_edges, "1 edge belongs to more than two triangles.",
       "{} edges belong to more than two triangles.");
  warn(report.inconsistent_edges,
       "1 edge joins two triangles of opposite winding; normals there are a guess.",
       "{} edges join two triangles of opposite winding; normals there are a guess.");
  warn(report.duplicate_triangles, "1 triangle repeats an earlier one.",
       "{} triangles repeat an earlier one.");
  warn(report.degenerate_triangles, "1 triangle has no area.", "{} triangles have no area.");
  if (report.self_intersections > 0) {
    const SelfIntersection& first = report.first_self_intersections.front();
    sentences.push_back(fmt::format(
        "The surface intersects itself: {}{} of triangles, first {} and {} near "
        "({:g}, {:g}, {:g}).{}",
        report.self_intersections_complete ? "" : "at least ",
        counted(report.self_intersections, "pair"), first.triangles[0], first.triangles[1],
        first.near[0], first.near[1], first.near[2],
        report.closed && report.consistent ? " Winding numbers decide what is inside." : ""));
  }
  if (report.closed && report.consistent && report.signed_volume < 0)
    sentences.emplace_back("The surface is inside out: its volume is negative.");
  return sentences;
}

}  // namespace ist
