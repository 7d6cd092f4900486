#include "ist/query/triangles/triangle_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

double dot(const Vector& a, const Vector& b) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }
double squared(const Vector& a) { return dot(a, a); }

// Edges more nearly parallel than this count as parallel: the closest points of two such edges are
// then found at an end, and of an edge and a face at an edge, to within that part of an edge.
constexpr double kParallel = 0x1p-26;

double to_segment(const Vector& p, const Vector& a, const Vector& b) {
  const Vector ab = b - a, ap = p - a;
  const double length = squared(ab);
  const double t = length > 0 ? std::clamp(dot(ap, ab) / length, 0.0, 1.0) : 0;
  return squared(ap - t * ab);
}

// Returns the squared distance between two edges' lines if their common perpendicular meets both
// edges, else infinity: then an end of one edge is a closest point.
double between_edges(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
  const Vector u = b - a, v = d - c, w = c - a;
  const Vector n = u.cross(v);
  const double nn = squared(n);
  if (!(nn > kParallel * kParallel * squared(u) * squared(v))) return HUGE_VAL;
  const double s = dot(w.cross(v), n), t = dot(w.cross(u), n);
  if (s < 0 || s > nn || t < 0 || t > nn) return HUGE_VAL;
  const double height = dot(w, n);
  return height * height / nn;
}

// Returns the squared distance of a corner from a face if its perpendicular meets the face, else
// infinity.
double to_face(const Vector& p, const TriangleCorners& t) {
  const Vector u = t[1] - t[0], v = t[2] - t[0], n = u.cross(v);
  const double nn = squared(n);
  if (!(nn > kParallel * kParallel * squared(u) * squared(v))) return HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector &a = t[i], &b = t[(i + 1) % 3];
    if (dot((b - a).cross(p - a), n) < 0) return HUGE_VAL;
  }
  const double height = dot(p - t[0], n);
  return height * height / nn;
}

}  // namespace

double distance_squared(const TriangleCorners& a, const TriangleCorners& b) noexcept {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min({least, to_face(a[i], b), to_face(b[i], a)});
    for (std::size_t j = 0; j < 3; ++j) {
      const Vector &p = a[i], &q = a[(i + 1) % 3], &r = b[j], &s = b[(j + 1) % 3];
      least =
          std::min({least, between_edges(p, q, r, s), to_segment(p, r, s), to_segment(r, p, q)});
    }
  }
  return least;
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
    const double x = dot(t[0], v), y = dot(t[1], v), z = dot(t[2], v);
    return x <= y ? (x <= z ? t[0] : t[2]) : (y <= z ? t[1] : t[2]);
  };
  Vector v = ((a[0] + a[1]) + a[2]) / 3 - ((b[0] + b[1]) + b[2]) / 3;
  for (int look = 0; look < kLooks; ++look) {
    const Vector w = farthest_against(a, v) - farthest_against(b, -v);
    const double along = dot(v, w), length = squared(v);
    // Every difference of points is at least as far along v as w, and so is the one nearest to the
    // origin.
    if (along > 0 && along * along > distance * distance * length * kRounding) return true;
    const Vector step = w - v;
    const double t = squared(step);
    if (!(t > 0)) return false;
    v += std::clamp(-dot(v, step) / t, 0.0, 1.0) * step;
  }
  return false;
}

}  // namespace ist
