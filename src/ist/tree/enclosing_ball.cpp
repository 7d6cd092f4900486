#include "ist/tree/enclosing_ball.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "ist/base/assert.h"

namespace ist {
namespace {

using Eigen::Vector3d;

constexpr int kMaxPasses = 64;

double square(const Vector3d& v) noexcept { return (v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]; }

struct Farthest {
  std::size_t index;
  double distance2;
};

// Returns the point farthest from `centre`, which is relative to `origin`.
Farthest farthest_from(std::span<const Vector3d> points, const Vector3d& origin,
                       const Vector3d& centre) noexcept {
  Farthest farthest{0, -1};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance2 = square((points[i] - origin) - centre);
    if (distance2 > farthest.distance2) farthest = {i, distance2};
  }
  return farthest;
}

// Returns the centre of the smallest ball through `count` points, 2 to 4. The centre of degenerate
// points is not finite; its ball holds no other point, so the caller skips it.
Vector3d circumcentre(const Vector3d* const points[4], int count) noexcept {
  const Vector3d& p = *points[0];
  const Vector3d a = *points[1] - p;
  if (count == 2) return p + 0.5 * a;
  const Vector3d b = *points[2] - p;
  const Vector3d ab = a.cross(b);
  if (count == 3) {
    return p + (square(b) * ab.cross(a) + square(a) * b.cross(ab)) / (2 * square(ab));
  }
  const Vector3d c = *points[3] - p;
  return p + (square(a) * b.cross(c) + square(b) * c.cross(a) + square(c) * ab) / (2 * ab.dot(c));
}

// The support points of a ball, and the ball.
struct Basis {
  Vector3d points[4];
  int count = 0;
  Vector3d centre;
  double radius2 = 0;
};

// Replaces the basis by that of the smallest ball of the basis and `point`, which lies outside and
// so becomes a support point. Tries each set with `point`, smallest sets first. Returns false if
// rounding hides the ball.
bool take_in(Basis& basis, const Vector3d& point) noexcept {
  constexpr double kSlack = 1 + 1e-12;
  Basis best;
  best.radius2 = std::numeric_limits<double>::infinity();
  for (int size = 1; size <= 3; ++size) {
    for (unsigned chosen = 1; chosen < 1u << basis.count; ++chosen) {
      if (__builtin_popcount(chosen) != size) continue;
      const Vector3d* set[4] = {&point};
      int count = 1;
      for (int i = 0; i < basis.count; ++i) {
        if ((chosen >> i & 1) != 0) set[count++] = &basis.points[i];
      }
      const Vector3d centre = circumcentre(set, count);
      const double radius2 = square(point - centre);
      if (!(radius2 < best.radius2)) continue;
      bool holds_all = true;
      for (int i = 0; i < basis.count && holds_all; ++i) {
        holds_all = square(basis.points[i] - centre) <= radius2 * kSlack;
      }
      if (!holds_all) continue;
      best.centre = centre;
      best.radius2 = radius2;
      best.count = count;
      for (int i = 0; i < count; ++i) best.points[i] = *set[i];
    }
    if (best.count == 2) break;  // no ball through more points is smaller
  }
  if (best.count == 0) return false;
  basis = best;
  return true;
}

}  // namespace

Ball enclosing_ball(std::span<const Vector3d> points, double tolerance) noexcept {
  IST_ASSERT(!points.empty());
  // Coordinates are relative to one of the points, so that a small ball far out rounds like one at
  // the origin.
  const Vector3d& origin = points[0];
  const Vector3d zero = Vector3d::Zero();
  Basis basis;
  basis.points[0] = points[farthest_from(points, origin, zero).index] - origin;
  basis.points[1] = points[farthest_from(points, origin, basis.points[0]).index] - origin;
  basis.count = 2;
  basis.centre = basis.points[0] + 0.5 * (basis.points[1] - basis.points[0]);
  basis.radius2 = square(basis.points[0] - basis.centre);
  Farthest outside = farthest_from(points, origin, basis.centre);
  Vector3d centre = basis.centre;
  double least = outside.distance2;
  const double enough = (1 + tolerance) * (1 + tolerance);
  for (int pass = 0; pass < kMaxPasses && outside.distance2 > basis.radius2 * enough; ++pass) {
    if (!take_in(basis, points[outside.index] - origin)) break;
    outside = farthest_from(points, origin, basis.centre);
    if (outside.distance2 < least) {
      centre = basis.centre;
      least = outside.distance2;
    }
  }
  centre += origin;
  return {centre, std::sqrt(farthest_from(points, centre, zero).distance2)};
}

}  // namespace ist
