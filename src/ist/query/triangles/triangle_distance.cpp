#include "ist/query/triangles/triangle_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

ClosestPoint plain(const Vector& v) { return {v[0], v[1], v[2]}; }
ClosestTriangle plain(const TriangleCorners& t) { return {plain(t[0]), plain(t[1]), plain(t[2])}; }
Vector vector(const ClosestPoint& p) { return {p[0], p[1], p[2]}; }

TrianglePart corner_part(std::size_t k) { return static_cast<TrianglePart>(k % 3); }
TrianglePart edge_part(std::size_t k) { return static_cast<TrianglePart>(3 + k); }

// A point of a triangle, and the smallest part that holds it.
struct PartPoint {
  ClosestPoint point;
  TrianglePart part;
};

PartPoint corner_point(const ClosestSide& t, std::size_t k) {
  return {t.corner[k], corner_part(k)};
}
// Returns the point of edge k behind `by` of it.
PartPoint edge_point(const ClosestSide& t, std::size_t k, double by) {
  if (by == 0) return corner_point(t, k);
  if (by == 1) return corner_point(t, (k + 1) % 3);
  return {along(t.corner[k], by, t.edge[k]), edge_part(k)};
}

NearPair near_pair(TrianglePair triangles, double square, const PartPoint& a, const PartPoint& b) {
  return {triangles, std::sqrt(square), vector(a.point), vector(b.point), a.part, b.part};
}

// Tries ClosestParts.
ClosestTry try_parts(const ClosestSide& a, const ClosestSide& b, std::size_t parts) {
  using Parts = ClosestParts;
  if (parts < Parts::kFaceToCorner) return try_face(a.corner[parts], b);
  if (parts < Parts::kEdges) return try_face(b.corner[parts - Parts::kFaceToCorner], a);
  const std::size_t i = (parts - Parts::kEdges) % 9 / 3, j = (parts - Parts::kEdges) % 3;
  if (parts < Parts::kCornerToEdge) return try_edges(a, i, b, j);
  if (parts < Parts::kEdgeToCorner) return try_edge(a.corner[i], b, j);
  return try_edge(b.corner[j], a, i);
}

// Returns the smallest part that holds the point of edge k behind `by` of it.
TrianglePart part_at(std::size_t k, double by) {
  return by == 0 ? corner_part(k) : by == 1 ? corner_part(k + 1) : edge_part(k);
}

// Returns the smallest parts that hold the points of a try of ClosestParts.
std::pair<TrianglePart, TrianglePart> parts_at(std::size_t parts, const ClosestTry& tried) {
  using Parts = ClosestParts;
  if (parts < Parts::kFaceToCorner) return {corner_part(parts), TrianglePart::kFace};
  if (parts < Parts::kEdges)
    return {TrianglePart::kFace, corner_part(parts - Parts::kFaceToCorner)};
  const std::size_t i = (parts - Parts::kEdges) % 9 / 3, j = (parts - Parts::kEdges) % 3;
  if (parts < Parts::kCornerToEdge) return {part_at(i, tried.first), part_at(j, tried.second)};
  if (parts < Parts::kEdgeToCorner) return {corner_part(i), part_at(j, tried.first)};
  return {part_at(i, tried.first), corner_part(j)};
}

// Returns the points of a try of ClosestParts.
NearPair points_of(const ClosestSide& a, const ClosestSide& b, TrianglePair triangles,
                   std::size_t parts, const ClosestTry& tried) {
  using Parts = ClosestParts;
  if (parts < Parts::kFaceToCorner) {
    return near_pair(triangles, tried.square, corner_point(a, parts),
                     {along(a.corner[parts], tried.first, b.normal), TrianglePart::kFace});
  }
  if (parts < Parts::kEdges) {
    const std::size_t k = parts - Parts::kFaceToCorner;
    return near_pair(triangles, tried.square,
                     {along(b.corner[k], tried.first, a.normal), TrianglePart::kFace},
                     corner_point(b, k));
  }
  const std::size_t i = (parts - Parts::kEdges) % 9 / 3, j = (parts - Parts::kEdges) % 3;
  if (parts < Parts::kCornerToEdge) {
    return near_pair(triangles, tried.square, edge_point(a, i, tried.first),
                     edge_point(b, j, tried.second));
  }
  if (parts < Parts::kEdgeToCorner) {
    return near_pair(triangles, tried.square, corner_point(a, i), edge_point(b, j, tried.first));
  }
  return near_pair(triangles, tried.square, edge_point(a, i, tried.first), corner_point(b, j));
}

// Returns the points of ClosestParts.
NearPair points_of(const ClosestSide& a, const ClosestSide& b, TrianglePair triangles,
                   std::size_t parts) {
  return points_of(a, b, triangles, parts, try_parts(a, b, parts));
}

// An axis-aligned box of some points.
struct PlainBox {
  ClosestPoint low, high;

  explicit PlainBox(const ClosestPoint& p) : low(p), high(p) {}
  PlainBox(const ClosestPoint& p, const ClosestPoint& q) : PlainBox(p) { add(q); }
  void add(const ClosestPoint& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  // Returns whether another box may be within a distance.
  [[nodiscard]] bool is_near(const PlainBox& other, double distance) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (other.low[i] - high[i] > distance || low[i] - other.high[i] > distance) return false;
    }
    return true;
  }
};

// The corners and edges of a triangle that are no farther from another one's plane and box than
// `enough`, with room for rounding. The others have no near part.
struct NearSides {
  bool corner[3], edge[3];

  NearSides(const ClosestSide& t, const ClosestSide& face, double enough) {
    double height[3];
    const double most = (kRounding * enough) * std::sqrt(face.area);
    for (std::size_t k = 0; k < 3; ++k) {
      height[k] = dot(t.corner[k] - face.corner[0], face.normal);
      corner[k] = !face.flat || !(std::abs(height[k]) > most);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double a = height[k], b = height[(k + 1) % 3];
      edge[k] = !face.flat || !((a > most && b > most) || (a < -most && b < -most));
    }
    PlainBox box(face.corner[0], face.corner[1]);
    box.add(face.corner[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = corner[k] && box.is_near(PlainBox(t.corner[k]), kRounding * enough);
      edge[k] = edge[k] && box.is_near(box_of_edge(t, k), kRounding * enough);
    }
  }
  static PlainBox box_of_edge(const ClosestSide& t, std::size_t k) {
    return {t.corner[k], t.corner[(k + 1) % 3]};
  }
  static constexpr double kRounding = 1 + 0x1p-20;
};

// A point in which an edge meets a plane, and how deep it lies in the triangle of that plane, as a
// part of its size.
struct Crossing {
  PartPoint on_edge;
  double depth;
};

// Returns where edge k of `t` meets the plane of `face`; nothing if both ends are on one side.
std::optional<Crossing> crossing(const ClosestSide& t, std::size_t k, const ClosestSide& face) {
  const double from = dot(t.corner[k] - face.corner[0], face.normal);
  const double to = dot(t.corner[(k + 1) % 3] - face.corner[0], face.normal);
  if (!face.flat || from * to > 0 || from == to) return std::nullopt;
  const PartPoint at = edge_point(t, k, from / (from - to));
  double depth = HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = dot(cross(face.edge[i], at.point - face.corner[i]), face.normal);
    depth = std::min(depth, side / face.area);
  }
  return Crossing{at, depth};
}

// Returns a common point of two triangles that intersect: the one in which an edge crosses the
// other triangle farthest from its border, or, of triangles in one plane, their closest points.
NearPair common_point(const ClosestSide& a, const ClosestSide& b, TrianglePair triangles) {
  std::optional<Crossing> best;
  bool edge_of_first = false;
  for (std::size_t k = 0; k < 6; ++k) {
    const bool first = k < 3;
    const std::optional<Crossing> at = first ? crossing(a, k, b) : crossing(b, k - 3, a);
    if (!at || (best && !(at->depth > best->depth))) continue;
    best = at;
    edge_of_first = first;
  }
  // Beside the border by more than rounding, no edge crosses: the triangles lie in one plane.
  if (!best || best->depth < -kParallel) {
    NearPair pair = points_of(a, b, triangles, ClosestFound(a, b).parts);
    pair.distance = 0;
    pair.moving_point = pair.fixed_point;
    return pair;
  }
  const PartPoint in_face{best->on_edge.point, TrianglePart::kFace};
  return edge_of_first ? near_pair(triangles, 0, best->on_edge, in_face)
                       : near_pair(triangles, 0, in_face, best->on_edge);
}

}  // namespace

Vector NearPair::direction() const noexcept {
  const ScopedFloatEnvironment environment;
  const Vector way = difference(moving_point, fixed_point);
  const double length = length_in_order(way);
  return distance > 0 && length > 0 ? scaled(1 / length, way) : Vector(0, 0, 0);
}

double distance_squared(const TriangleCorners& a, const TriangleCorners& b) noexcept {
  const ClosestTriangle first = plain(a), second = plain(b);
  return ClosestFound(ClosestSide(first), ClosestSide(second)).square;
}

NearPair closest_points(const TriangleCorners& a, const TriangleCorners& b,
                        TrianglePair triangles) noexcept {
  const ClosestTriangle first = plain(a), second = plain(b);
  return closest_points(a, b, triangles,
                        ClosestFound(ClosestSide(first), ClosestSide(second)).parts);
}

NearPair closest_points(const TriangleCorners& a, const TriangleCorners& b, TrianglePair triangles,
                        std::size_t parts) noexcept {
  const ClosestTriangle first = plain(a), second = plain(b);
  const ClosestSide of_a(first), of_b(second);
  NearPair pair = points_of(of_a, of_b, triangles, parts);
  pair.distance = std::max(pair.distance, kLeastDistance);
  const Vector way = pair.moving_point - pair.fixed_point;
  if (surely_parted(a, b, pair.fixed_point, way) || !triangles_meet(a, b)) return pair;
  return common_point(of_a, of_b, triangles);
}

std::size_t near_parts(const TriangleCorners& a, const TriangleCorners& b, TrianglePair triangles,
                       double enough, std::span<NearPair, Query::kMostNearParts> out) noexcept {
  using Parts = ClosestParts;
  const ClosestTriangle first = plain(a), second = plain(b);
  const ClosestSide of_a(first), of_b(second);
  std::size_t count = 0;
  const auto add = [&](std::size_t parts, const ClosestTry& tried) {
    if (!(tried.square < HUGE_VAL && std::sqrt(tried.square) <= enough)) return;
    const auto [fixed, moving] = parts_at(parts, tried);
    // Corners are found by several edges, with roundings of their own.
    std::size_t at = 0;
    while (at < count && !(out[at].fixed_part == fixed && out[at].moving_part == moving)) ++at;
    const double distance = std::sqrt(tried.square);
    if (at == count) {
      ++count;
    } else if (!(distance < out[at].distance)) {
      return;
    }
    // The pair goes there, or before.
    for (; at > 0 && distance < out[at - 1].distance; --at) out[at] = out[at - 1];
    out[at] = points_of(of_a, of_b, triangles, parts, tried);
  };
  const NearSides near_a(of_a, of_b, enough), near_b(of_b, of_a, enough);
  constexpr ClosestTry kNone{HUGE_VAL, 0, 0};
  ClosestTry to_edge[3][3], to_corner[3][3];  // from corner i and from edge i of the first
  for (std::size_t i = 0; i < 3; ++i) {
    if (near_a.corner[i]) add(Parts::kCornerToFace + i, try_face(of_a.corner[i], of_b));
    for (std::size_t j = 0; j < 3; ++j) {
      to_edge[i][j] = near_a.corner[i] ? try_edge(of_a.corner[i], of_b, j) : kNone;
      to_corner[i][j] = near_b.corner[j] ? try_edge(of_b.corner[j], of_a, i) : kNone;
    }
  }
  for (std::size_t j = 0; j < 3; ++j) {
    if (near_b.corner[j]) add(Parts::kFaceToCorner + j, try_face(of_b.corner[j], of_a));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!near_a.edge[i]) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      if (!near_b.edge[j] || !NearSides::box_of_edge(of_a, i).is_near(
                                 NearSides::box_of_edge(of_b, j), NearSides::kRounding * enough)) {
        continue;
      }
      // The closest points of two edges lie inside both, or at an end of one.
      const std::size_t next_i = (i + 1) % 3, next_j = (j + 1) % 3;
      std::size_t best = Parts::kEdges + 3 * i + j;
      ClosestTry nearest = try_edges(of_a, i, of_b, j);
      const auto take = [&](std::size_t parts, const ClosestTry& tried) {
        if (!(tried.square < nearest.square)) return;
        nearest = tried;
        best = parts;
      };
      take(Parts::kCornerToEdge + 3 * i + j, to_edge[i][j]);
      take(Parts::kCornerToEdge + 3 * next_i + j, to_edge[next_i][j]);
      take(Parts::kEdgeToCorner + 3 * i + j, to_corner[i][j]);
      take(Parts::kEdgeToCorner + 3 * i + next_j, to_corner[i][next_j]);
      add(best, nearest);
    }
  }
  return count;
}

bool surely_parted(const TriangleCorners& a, const TriangleCorners& b, const Vector& near,
                   const Vector& way) noexcept {
  constexpr double kRounding = 0x1p-48;
  double first = -HUGE_VAL, second = HUGE_VAL, size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector p = a[k] - near, q = b[k] - near;
    first = std::max(first, dot_in_order(p, way));
    second = std::min(second, dot_in_order(q, way));
    size = std::max({size, p.cwiseAbs().maxCoeff(), q.cwiseAbs().maxCoeff()});
  }
  return second - first > kRounding * size * way.cwiseAbs().maxCoeff();
}

PlainMove plain_move(const Eigen::Isometry3d& pose) noexcept {
  PlainMove move;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) move.rotation[i][j] = pose(i, j);
    move.translation[i] = pose(i, 3);
  }
  return move;
}

double box_distance_squared(const TriangleCorners& a, const TriangleCorners& b) noexcept {
  double sum = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto [a_low, a_high] = std::minmax({a[0][axis], a[1][axis], a[2][axis]});
    const auto [b_low, b_high] = std::minmax({b[0][axis], b[1][axis], b[2][axis]});
    const double apart = std::max({0.0, b_low - a_high, a_low - b_high});
    sum += apart * apart;
  }
  return sum;
}

bool surely_farther(const TriangleCorners& a, const TriangleCorners& b, double distance) noexcept {
  constexpr int kLooks = 4;
  constexpr double kRounding = 1 + 0x1p-40;
  // Returns the corner of a triangle that is farthest against `v`, a support point of the Minkowski
  // difference.
  const auto farthest_against = [](const TriangleCorners& t, const Vector& v) {
    const double x = dot_in_order(t[0], v), y = dot_in_order(t[1], v), z = dot_in_order(t[2], v);
    return x <= y ? (x <= z ? t[0] : t[2]) : (y <= z ? t[1] : t[2]);
  };
  Vector v = ((a[0] + a[1]) + a[2]) / 3 - ((b[0] + b[1]) + b[2]) / 3;
  for (int look = 0; look < kLooks; ++look) {
    const Vector w = farthest_against(a, v) - farthest_against(b, -v);
    const double along = dot_in_order(v, w), length = square_in_order(v);
    // Every difference of points is at least as far along v as w, and so is the one nearest to the
    // origin.
    if (along > 0 && along * along > distance * distance * length * kRounding) return true;
    const Vector step = w - v;
    const double t = square_in_order(step);
    if (!(t > 0)) return false;
    v += std::clamp(-dot_in_order(v, step) / t, 0.0, 1.0) * step;
  }
  return false;
}

}  // namespace ist
