#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

/// The closest points of two triangles in double: the interface of its kernels, and the scalar form
/// of one pair, which specifies them. All forms have the same bits.
namespace ist {

using ClosestPoint = std::array<double, 3>;
using ClosestTriangle = std::array<ClosestPoint, 3>;

/// Eight pairs of triangles side by side: corner, coordinate, pair. The moving ones are in their
/// own coordinates.
struct alignas(64) TriangleOctet {
  static constexpr std::size_t kSize = 8;
  double fixed[3][3][kSize], moving[3][3][kSize];
};

/// The rigid motion from moving to fixed coordinates, in plain numbers.
struct PlainMove {
  double rotation[3][3], translation[3];

  /// Moves a point as RigidMove does, bit by bit.
  [[nodiscard]] ClosestPoint operator()(const ClosestPoint& p) const noexcept {
    ClosestPoint moved;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& r = rotation[i];
      moved[i] = ((r[0] * p[0] + r[1] * p[1]) + r[2] * p[2]) + translation[i];
    }
    return moved;
  }
};

/// The closest parts of eight pairs of triangles.
struct alignas(64) OctetDistances {
  double square[TriangleOctet::kSize];  ///< of the distance
  double parts[TriangleOctet::kSize];   ///< a whole number: see ClosestParts
};

/// Finds the closest parts of eight pairs of triangles. Triangles that intersect have the parts of
/// their borders that are closest, and their square is not that of a distance.
using ClosestOctetFunction = void (*)(const TriangleOctet& pairs, const PlainMove& move,
                                      OctetDistances& out);

/// The parts of two triangles that hold their closest points: a number for each kind.
///
///     0 … 2    corner i of the first, face of the second
///     3 … 5    corner i of the second, face of the first
///     6 … 14   edge i of the first, edge j of the second: 6 + 3 i + j
///     15 … 23  corner i of the first, edge j of the second
///     24 … 32  corner j of the second, edge i of the first: 24 + 3 i + j
///
/// Edge k goes from corner k to corner (k + 1) % 3.
struct ClosestParts {
  static constexpr std::size_t kCornerToFace = 0, kFaceToCorner = 3, kEdges = 6, kCornerToEdge = 15,
                               kEdgeToCorner = 24, kCount = 33;
};

/// Edges more nearly parallel than this count as parallel: the closest points of two such edges are
/// then found at an end, and of an edge and a face at an edge, to within that part of an edge.
inline constexpr double kParallel = 0x1p-26;

[[nodiscard]] inline ClosestPoint operator-(const ClosestPoint& a, const ClosestPoint& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline double dot(const ClosestPoint& a, const ClosestPoint& b) noexcept {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}
[[nodiscard]] inline ClosestPoint cross(const ClosestPoint& a, const ClosestPoint& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// Returns p + by · v.
[[nodiscard]] inline ClosestPoint along(const ClosestPoint& p, double by,
                                        const ClosestPoint& v) noexcept {
  return {p[0] + by * v[0], p[1] + by * v[1], p[2] + by * v[2]};
}

/// A triangle with its edges and its normal.
struct ClosestSide {
  const ClosestTriangle& corner;
  ClosestPoint edge[3], normal;
  double length[3], area;  ///< squares of the edges' lengths, and of twice the area
  bool flat;               ///< it has an area that is more than rounding

  explicit ClosestSide(const ClosestTriangle& t) noexcept : corner(t) {
    for (std::size_t k = 0; k < 3; ++k) {
      edge[k] = t[(k + 1) % 3] - t[k];
      length[k] = dot(edge[k], edge[k]);
    }
    const ClosestPoint v = t[2] - t[0];
    normal = cross(edge[0], v);
    area = dot(normal, normal);
    flat = area > ((kParallel * kParallel) * length[0]) * length[2];
  }
};

/// A candidate for the closest parts: the square of its distance, infinite if the perpendicular
/// does not meet both parts, and where its points are along them.
struct ClosestTry {
  double square, first, second;
};

/// Tries a corner and a face. `first` is the way from the corner to the face, in normals.
[[nodiscard]] inline ClosestTry try_face(const ClosestPoint& p, const ClosestSide& face) noexcept {
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    const double side = dot(cross(face.edge[k], p - face.corner[k]), face.normal);
    least = side < least ? side : least;
  }
  const double height = dot(p - face.corner[0], face.normal);
  const double by = height / face.area;
  return {face.flat && least >= 0 ? (height * height) / face.area : HUGE_VAL, -by, 0};
}

/// Tries two edges, from their first corners p and q. `first` and `second` are the parts of the
/// edges before their closest points.
[[nodiscard]] inline ClosestTry try_edges(const ClosestSide& a, std::size_t i, const ClosestSide& b,
                                          std::size_t j) noexcept {
  const ClosestPoint &u = a.edge[i], &v = b.edge[j];
  const ClosestPoint w = b.corner[j] - a.corner[i], n = cross(u, v);
  const double area = dot(n, n);
  const double s = dot(cross(w, v), n), t = dot(cross(w, u), n), height = dot(w, n);
  const bool meets = area > ((kParallel * kParallel) * a.length[i]) * b.length[j] && s >= 0 &&
                     s <= area && t >= 0 && t <= area;
  return {meets ? (height * height) / area : HUGE_VAL, s / area, t / area};
}

/// Tries a corner and an edge. `first` is the part of the edge before its closest point.
[[nodiscard]] inline ClosestTry try_edge(const ClosestPoint& p, const ClosestSide& t,
                                         std::size_t k) noexcept {
  const ClosestPoint from = p - t.corner[k];
  const double part = dot(from, t.edge[k]) / t.length[k];
  const double clamped = part < 0 ? 0 : 1 < part ? 1 : part;
  const double by = t.length[k] > 0 ? clamped : 0;
  const ClosestPoint way = along(from, -by, t.edge[k]);
  return {dot(way, way), by, 0};
}

/// The closest parts of two triangles; of equal ones those with the smallest number.
struct ClosestFound {
  double square = HUGE_VAL;
  std::size_t parts = 0;

  ClosestFound(const ClosestSide& a, const ClosestSide& b) noexcept {
    std::size_t number = 0;
    const auto take = [&](double tried) {
      parts = tried < square ? number : parts;
      square = tried < square ? tried : square;
      ++number;
    };
    for (const ClosestPoint& p : a.corner) take(try_face(p, b).square);
    for (const ClosestPoint& p : b.corner) take(try_face(p, a).square);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) take(try_edges(a, i, b, j).square);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) take(try_edge(a.corner[i], b, j).square);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) take(try_edge(b.corner[j], a, i).square);
    }
  }
};

/// The scalar form of ClosestOctetFunction.
void closest_octet_scalar(const TriangleOctet& pairs, const PlainMove& move, OctetDistances& out);

}  // namespace ist
