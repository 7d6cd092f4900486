#include "ist/mesh/pseudonormals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ist/base/angles.h"
#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;
// Of more triangles without an area in a row none is the way to a neighbour.
constexpr int kMostWithoutArea = 16;
// Vertices that are nearer, as a part of the longest edge, are at one place.
constexpr double kSamePlace = 1e-12;

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

// The edge of its triangle that this is a use of.
std::size_t edge_of(const TriangleMesh& mesh, const EdgeUse& use) {
  const Triangle& t = mesh.triangles[use.triangle];
  const std::uint32_t from = use.forward ? use.low : use.high;
  return static_cast<std::size_t>(std::find(t.begin(), t.end(), from) - t.begin());
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
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  const std::vector<bool> is_open = join_neighbours(mesh, uses);
  DisjointSets places(mesh.vertices.size());  // vertices at one position
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    if (!has_equal_indices(mesh.triangles[triangle])) add_angles(mesh, triangle, places);
  }
  // All vertices at a place have the sum of all.
  std::vector<Vector> sums(of_vertex_.size(), Vector(0, 0, 0));
  std::vector<bool> open_places(sums.size());
  for (std::uint32_t v = 0; v < sums.size(); ++v) {
    add_to(sums[places.find(v)], of_vertex_[v]);
    if (is_open[v]) open_places[places.find(v)] = true;
  }
  for (std::uint32_t v = 0; v < sums.size(); ++v) {
    const std::uint32_t place = places.find(v);
    of_vertex_[v] = open_places[place] ? Vector(0, 0, 0) : sums[place];
  }
}

// Finds the neighbours of each triangle. Returns the vertices of edges where there is not one.
std::vector<bool> Pseudonormals::join_neighbours(const TriangleMesh& mesh,
                                                 std::span<const EdgeUse> uses) {
  std::vector<bool> is_open(mesh.vertices.size());
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2 && edge[0].forward != edge[1].forward) {
      across_[edge[0].triangle][edge_of(mesh, edge[0])] = edge[1].triangle;
      across_[edge[1].triangle][edge_of(mesh, edge[1])] = edge[0].triangle;
      return;
    }
    closed_ = closed_ && is_balanced(edge);
    is_open[edge[0].low] = is_open[edge[0].high] = true;
  });
  // A triangle with two equal indices stands on an edge of others, if on any.
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    const Triangle& t = mesh.triangles[triangle];
    if (!has_equal_indices(t)) continue;
    const auto [low, high] = std::minmax_element(t.begin(), t.end());
    const auto use = std::lower_bound(
        uses.begin(), uses.end(), std::pair(*low, *high),
        [](const EdgeUse& one, const auto& edge) { return std::pair(one.low, one.high) < edge; });
    if (use == uses.end() || use->low != *low || use->high != *high) continue;
    across_[triangle][0] = use->triangle;
  }
  return is_open;
}

// Adds a face's normal to its vertices, by its angles there. One without an area joins vertices at
// one position; or its middle vertex lies on an edge of the neighbour, whose angle there is half a
// turn.
void Pseudonormals::add_angles(const TriangleMesh& mesh, std::uint32_t triangle,
                               DisjointSets& places) {
  const Triangle& indices = mesh.triangles[triangle];
  const std::array<Vector, 3> t = corners(mesh, triangle);
  const Vector normal = unit_normal(t);
  if (!is_zero(normal)) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector u = difference(t[(i + 1) % 3], t[i]), v = difference(t[(i + 2) % 3], t[i]);
      const double angle = angle_of(length_of(cross_in_order(u, v)), dot_in_order(u, v));
      add_to(of_vertex_[indices[i]], scaled(angle, normal));
    }
    return;
  }
  double length[3], longest = 0;
  std::size_t edge = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    length[i] = length_of(difference(t[(i + 1) % 3], t[i]));
    if (length[i] > longest) edge = i;
    longest = std::max(longest, length[i]);
  }
  bool apart = true;
  for (std::size_t i = 0; i < 3; ++i) {
    if (length[i] > kSamePlace * longest) continue;
    places.join(indices[i], indices[(i + 1) % 3]);
    apart = false;
  }
  const std::uint32_t neighbour = across_[triangle][edge];
  if (!apart || neighbour == kNone) return;
  const std::size_t middle = (edge + 2) % 3;
  add_to(of_vertex_[indices[middle]],
         scaled(std::numbers::pi, beyond(mesh, neighbour, triangle, t[middle])));
}

std::optional<Vector> Pseudonormals::at(const TriangleMesh& mesh, std::uint32_t triangle,
                                        const NearestPoint& on) const noexcept {
  Vector normal;
  const bool is_edge = on.feature >= 3 && on.feature != NearestPoint::kInside;
  if (is_edge && has_equal_indices(mesh.triangles[triangle])) {
    return at_edge_below(mesh, triangle, on);
  }
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

// The normal at an edge on which a triangle with two equal indices stands.
std::optional<Vector> Pseudonormals::at_edge_below(const TriangleMesh& mesh, std::uint32_t triangle,
                                                   const NearestPoint& on) const noexcept {
  const std::uint32_t below = across_[triangle][0];
  if (below == kNone) return {};
  const Triangle &t = mesh.triangles[below], &above = mesh.triangles[triangle];
  const auto [low, high] = std::minmax_element(above.begin(), above.end());
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t a = t[i], b = t[(i + 1) % 3];
    if (std::min(a, b) != *low || std::max(a, b) != *high) continue;
    return at(mesh, below, {on.point, static_cast<int>(3 + i)});
  }
  return {};
}

// The normal of a triangle that was come to from its neighbour `from`; over triangles without an
// area, of the next one, by that edge of theirs which is nearest to `at`.
Vector Pseudonormals::beyond(const TriangleMesh& mesh, std::uint32_t triangle, std::uint32_t from,
                             const Vector& at) const noexcept {
  for (int step = 0; step < kMostWithoutArea; ++step) {
    const std::array<Vector, 3> t = corners(mesh, triangle);
    Vector normal = unit_normal(t);
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
