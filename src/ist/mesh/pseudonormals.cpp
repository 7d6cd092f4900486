#include "ist/mesh/pseudonormals.h"

#include <algorithm>
#include <cmath>

#include "ist/base/angles.h"
#include "ist/base/ordered_vector.h"
#include "ist/mesh/components.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;
// Of more triangles without an area in a row none is the way to a neighbour.
constexpr int kMostWithoutArea = 16;

double length_of(const Vector& v) { return std::sqrt(dot_in_order(v, v)); }

std::array<Vector, 3> corners(const TriangleMesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

// The unit normal of a face; zero where it has no area, by the measure of check_mesh().
Vector unit_normal(const std::array<Vector, 3>& t) {
  const Vector u = difference(t[1], t[0]), v = difference(t[2], t[0]), w = difference(t[2], t[1]);
  const Vector normal = cross_in_order(u, v);
  const double length = length_of(normal);
  const double longest = std::max({dot_in_order(u, u), dot_in_order(v, v), dot_in_order(w, w)});
  return length > 1e-12 * longest ? scaled(1 / length, normal) : Vector(0, 0, 0);
}

bool is_zero(const Vector& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

double to_edge_squared(const Vector& p, const Vector& a, const Vector& b) {
  const Vector edge = difference(b, a), way = difference(p, a);
  const double length = dot_in_order(edge, edge);
  const double part = length > 0 ? std::clamp(dot_in_order(way, edge) / length, 0.0, 1.0) : 0;
  const Vector left = difference(way, scaled(part, edge));
  return dot_in_order(left, left);
}

}  // namespace

Pseudonormals::Pseudonormals(const TriangleMesh& mesh)
    : across_(mesh.triangles.size(), {kNone, kNone, kNone}),
      of_vertex_(mesh.vertices.size(), Vector(0, 0, 0)) {
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    const std::array<Vector, 3> t = corners(mesh, triangle);
    const Vector normal = unit_normal(t);
    if (is_zero(normal)) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector u = difference(t[(i + 1) % 3], t[i]), v = difference(t[(i + 2) % 3], t[i]);
      const double angle = angle_of(length_of(cross_in_order(u, v)), dot_in_order(u, v));
      add_to(of_vertex_[mesh.triangles[triangle][i]], scaled(angle, normal));
    }
  }
  const auto edge_of = [&](const EdgeUse& use) {
    const Triangle& t = mesh.triangles[use.triangle];
    const std::uint32_t from = use.forward ? use.low : use.high;
    return static_cast<std::size_t>(std::find(t.begin(), t.end(), from) - t.begin());
  };
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2 && edge[0].forward != edge[1].forward) {
      across_[edge[0].triangle][edge_of(edge[0])] = edge[1].triangle;
      across_[edge[1].triangle][edge_of(edge[1])] = edge[0].triangle;
      return;
    }
    closed_ = false;
    of_vertex_[edge[0].low] = of_vertex_[edge[0].high] = {0, 0, 0};
  });
}

std::optional<Vector> Pseudonormals::at(const TriangleMesh& mesh, std::uint32_t triangle,
                                        const NearestPoint& on) const noexcept {
  Vector normal;
  if (on.feature == NearestPoint::kInside) {
    normal = unit_normal(corners(mesh, triangle));
  } else if (on.feature < 3) {
    normal = of_vertex_[mesh.triangles[triangle][static_cast<std::size_t>(on.feature)]];
  } else {
    const auto edge = static_cast<std::size_t>(on.feature - 3);
    const std::uint32_t neighbour = across_[triangle][edge];
    if (neighbour == kNone) return {};
    normal = sum(beyond(mesh, triangle, neighbour, on.point),
                 beyond(mesh, neighbour, triangle, on.point));
  }
  return is_zero(normal) ? std::nullopt : std::optional(normal);
}

// The normal of a triangle that was come to from its neighbour `from`; over triangles without an
// area, of the next one, by that edge of theirs which is nearest to `at`.
Vector Pseudonormals::beyond(const TriangleMesh& mesh, std::uint32_t triangle, std::uint32_t from,
                             const Vector& at) const noexcept {
  for (int step = 0; step < kMostWithoutArea; ++step) {
    const std::array<Vector, 3> t = corners(mesh, triangle);
    const Vector normal = unit_normal(t);
    if (!is_zero(normal)) return normal;
    std::uint32_t next = kNone;
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < 3; ++i) {
      const double square = to_edge_squared(at, t[i], t[(i + 1) % 3]);
      if (across_[triangle][i] == from || across_[triangle][i] == kNone || square >= least)
        continue;
      least = square;
      next = across_[triangle][i];
    }
    if (next == kNone) break;
    from = triangle;
    triangle = next;
  }
  return {0, 0, 0};
}

}  // namespace ist
