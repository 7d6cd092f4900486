#include "ist/mesh/triangles_meet.h"

#include <algorithm>
#include <span>

#include "ist/mesh/orientation.h"

namespace ist {
namespace {

using Points2 = std::span<const Eigen::Vector2d>;

// Returns whether the line through u and v, an edge of `own`, separates the two polygons, with no
// point of `other` on it.
bool edge_separates(const Eigen::Vector2d& u, const Eigen::Vector2d& v, Points2 own,
                    Points2 other) {
  const int side = orientation(u, v, other[0]);
  if (side == 0) return false;
  return std::all_of(other.begin() + 1, other.end(),
                     [&](const auto& p) { return orientation(u, v, p) == side; }) &&
         std::all_of(own.begin(), own.end(),
                     [&](const auto& p) { return orientation(u, v, p) != side; });
}

bool an_edge_separates(Points2 a, Points2 b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d &u = a[i], &v = a[(i + 1) % a.size()];
    if (u != v && edge_separates(u, v, a, b)) return true;
  }
  return false;
}

// Returns whether two points, segments or triangles of the plane, given by up to three corners, are
// separate. An axis separates collinear segments and points; otherwise the line of an edge does.
bool apart(Points2 a, Points2 b) {
  for (const Eigen::Index axis : {0, 1}) {
    const auto less = [axis](const auto& p, const auto& q) { return p[axis] < q[axis]; };
    const auto [a_low, a_high] = std::minmax_element(a.begin(), a.end(), less);
    const auto [b_low, b_high] = std::minmax_element(b.begin(), b.end(), less);
    if (less(*a_high, *b_low) || less(*b_high, *a_low)) return true;
  }
  return an_edge_separates(a, b) || an_edge_separates(b, a);
}

// Returns whether convex hulls of up to three points in one plane meet: they do if all their
// projections along the axes meet, since at least one of these is injective.
bool meet_in_a_plane(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Index u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<Eigen::Vector2d, 3> shadow_a, shadow_b;
    for (std::size_t i = 0; i < a.size(); ++i) shadow_a[i] = {a[i][u], a[i][v]};
    for (std::size_t i = 0; i < b.size(); ++i) shadow_b[i] = {b[i][u], b[i][v]};
    if (apart({shadow_a.data(), a.size()}, {shadow_b.data(), b.size()})) return false;
  }
  return true;
}

using Sides = std::array<int, 3>;

Sides sides_of(const TriangleCorners& points, const TriangleCorners& of) {
  const OrientedPlane plane(of[0], of[1], of[2]);
  return {plane.side_of(points[0]), plane.side_of(points[1]), plane.side_of(points[2])};
}

bool on_one_side(const Sides& sides) {
  return sides[0] != 0 && sides[0] == sides[1] && sides[0] == sides[2];
}

// Returns whether the segment from u to v meets `t`, which has area. `side_u` and `side_v` are the
// sides of t's plane on which u and v lie.
bool edge_meets(const Eigen::Vector3d& u, const Eigen::Vector3d& v, int side_u, int side_v,
                const TriangleCorners& t) {
  if (side_u * side_v > 0) return false;
  if (side_u == 0 && side_v == 0) {
    const Eigen::Vector3d edge[] = {u, v};
    return meet_in_a_plane(edge, t);
  }
  // The line pierces the plane; inside the triangle if it passes all edges on one side.
  const int first = orientation(u, v, t[0], t[1]);
  const int second = orientation(u, v, t[1], t[2]);
  if (first * second < 0) return false;
  const int third = orientation(u, v, t[2], t[0]);
  return first * third >= 0 && second * third >= 0;
}

// Returns whether an edge of `a` meets `b`, which has area. `sides` holds the sides of b's plane on
// which a's corners lie.
bool an_edge_meets(const TriangleCorners& a, const TriangleCorners& b, const Sides& sides) {
  return edge_meets(a[0], a[1], sides[0], sides[1], b) ||
         edge_meets(a[1], a[2], sides[1], sides[2], b) ||
         edge_meets(a[2], a[0], sides[2], sides[0], b);
}

// Tests two triangles without area by their edges.
bool edges_meet(const TriangleCorners& a, const TriangleCorners& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d of_a[] = {a[i], a[(i + 1) % 3]};
    for (std::size_t j = 0; j < 3; ++j) {
      const Eigen::Vector3d of_b[] = {b[j], b[(j + 1) % 3]};
      if (orientation(of_a[0], of_a[1], of_b[0], of_b[1]) == 0 && meet_in_a_plane(of_a, of_b)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

bool has_area(const TriangleCorners& t) noexcept {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Index u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto shadow = [&](std::size_t i) { return Eigen::Vector2d(t[i][u], t[i][v]); };
    if (orientation(shadow(0), shadow(1), shadow(2)) != 0) return true;
  }
  return false;
}

bool fans_meet(const TriangleCorners& a, const TriangleCorners& b) noexcept {
  const OrientedPlane of_a(a[0], a[1], a[2]), of_b(b[0], b[1], b[2]);
  const int b1 = of_a.side_of(b[1]), b2 = of_a.side_of(b[2]);
  if (b1 * b2 > 0) return false;
  const int a1 = of_b.side_of(a[1]), a2 = of_b.side_of(a[2]);
  if (a1 * a2 > 0) return false;
  // What they have in common is convex and holds the corner. If it holds more, it reaches the edge
  // of one triangle that is opposite the corner.
  return edge_meets(a[1], a[2], a1, a2, b) || edge_meets(b[1], b[2], b1, b2, a);
}

bool triangles_meet(const TriangleCorners& a, const TriangleCorners& b) noexcept {
  for (const Eigen::Vector3d& corner : a) {
    if (corner == b[0] || corner == b[1] || corner == b[2]) return true;
  }
  const Sides of_b = sides_of(b, a);
  if (on_one_side(of_b)) return false;
  const Sides of_a = sides_of(a, b);
  if (on_one_side(of_a)) return false;
  // Where two triangles meet, an edge of one meets the other. A triangle whose plane leaves a point
  // aside has area.
  constexpr Sides kNone = {0, 0, 0};
  const bool a_has_area = of_b != kNone || has_area(a), b_has_area = of_a != kNone || has_area(b);
  if (!a_has_area && !b_has_area) return edges_meet(a, b);
  return (b_has_area && an_edge_meets(a, b, of_a)) || (a_has_area && an_edge_meets(b, a, of_b));
}

}  // namespace ist
