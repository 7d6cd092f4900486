#include "ist/tree/enclosing_ball.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "ist/base/assert.h"
#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

using Eigen::Vector3d;

constexpr int kMaxPasses = 64;

double square(const Vector3d& v) noexcept { return square_in_order(v); }

// The sets of 0, 1, 2 and 3 of four sites, as bits; 16 ends a row.
constexpr unsigned kSets[4][7] = {
    {0, 16}, {1, 2, 4, 8, 16}, {3, 5, 6, 9, 10, 12, 16}, {7, 11, 13, 14, 16}};

struct Farthest {
  std::size_t index;
  double distance2;
};

// Returns the point farthest from `centre`, which is relative to `origin`.
Farthest farthest_from(std::span<const Vector3d> points, const Vector3d& origin,
                       const Vector3d& centre) noexcept {
  Farthest farthest{0, -1};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance2 = square(difference(difference(points[i], origin), centre));
    const bool is_farther = distance2 > farthest.distance2;
    farthest.index = is_farther ? i : farthest.index;
    farthest.distance2 = is_farther ? distance2 : farthest.distance2;
  }
  return farthest;
}

// Returns the vector in the span of d[0] … d[n - 1], n at most 3, whose product with d[i] is r[i].
// Not finite if they are dependent.
Vector3d of_products(const Vector3d d[3], const double r[3], int n) noexcept {
  if (n == 1) return d[0] * (r[0] / square(d[0]));
  const Vector3d ab = d[0].cross(d[1]);
  if (n == 2) return (r[1] * ab.cross(d[0]) + r[0] * d[1].cross(ab)) / square(ab);
  return (r[0] * d[1].cross(d[2]) + r[1] * d[2].cross(d[0]) + r[2] * ab) / dot_in_order(ab, d[2]);
}

// A ball by its centre and its size: the square of its radius round points, its radius round balls.
struct Sized {
  Vector3d centre;
  double size;
};
double size_to(const Vector3d& point, const Vector3d& centre) noexcept {
  return square(point - centre);
}
double size_to(const Ball& ball, const Vector3d& centre) noexcept {
  return std::sqrt(square(ball.centre - centre)) + ball.radius;
}

// Returns the smallest ball through `count` points, 2 to 4. That of degenerate points is not finite
// and holds no other point, so the caller skips it.
Sized touching(const Vector3d* const points[4], int count) noexcept {
  const Vector3d& p = *points[0];
  if (count == 2) {
    const Vector3d half = scaled(0.5, difference(*points[1], p));
    return {sum(p, half), square(half)};
  }
  Vector3d d[3];
  double squares[3];
  for (int i = 1; i < count; ++i) {
    d[i - 1] = *points[i] - p;
    squares[i - 1] = square(d[i - 1]);
  }
  const Vector3d centre = p + 0.5 * of_products(d, squares, count - 1);
  return {centre, square(p - centre)};
}

// Returns the smallest ball that `count` balls, 1 to 4, touch from inside. If no ball does, the
// result is not finite or does not hold them. The centre is c + u - h v, with c the first ball's
// centre and h the distance between the two.
Sized touching(const Ball* const balls[4], int count) noexcept {
  const Ball& ball = *balls[0];
  if (count == 1) return {ball.centre, ball.radius};
  Vector3d d[3];
  double excess[3], squares[3];
  for (int i = 1; i < count; ++i) {
    d[i - 1] = balls[i]->centre - ball.centre;
    excess[i - 1] = ball.radius - balls[i]->radius;
    squares[i - 1] = square(d[i - 1]) - excess[i - 1] * excess[i - 1];
  }
  const Vector3d u = 0.5 * of_products(d, squares, count - 1);
  const Vector3d v = of_products(d, excess, count - 1);
  const double a = 1 - square(v), b = dot_in_order(u, v);
  const double distance = (std::sqrt(b * b + a * square(u)) - b) / a;
  return {ball.centre + (u - distance * v), ball.radius + distance};
}

// Replaces the support by that of the smallest ball round the support and `site`, which lies
// outside and so becomes part of it. Tries each set with `site`, smallest sets first. Returns false
// if rounding hides the ball.
template <typename Site>
bool extend(Support<Site>& support, const Site& site) noexcept {
  constexpr double kSlack = 1 + 1e-12;
  const unsigned sets = 1u << support.count;
  Sized best{Vector3d::Zero(), std::numeric_limits<double>::infinity()};
  unsigned chosen = sets;
  for (int others = std::is_same_v<Site, Ball> ? 0 : 1; others <= 3; ++others) {
    for (const unsigned* set = kSets[others]; *set < sets; ++set) {
      const Site* sites[4] = {&site};
      int count = 1;
      for (int i = 0; i < support.count; ++i) {
        if ((*set >> i & 1) != 0) sites[count++] = &support.sites[i];
      }
      const Sized ball = touching(sites, count);
      if (!(ball.size < best.size)) continue;
      bool holds_all = true;
      for (int i = 0; i < support.count && holds_all; ++i) {
        holds_all = size_to(support.sites[i], ball.centre) <= ball.size * kSlack;
      }
      if (!holds_all) continue;
      best = ball;
      chosen = *set;
    }
    if (chosen < sets && others < 2) break;  // no ball that more of them touch is smaller
  }
  if (chosen == sets) return false;
  Site kept[4] = {site};
  int count = 1;
  for (int i = 0; i < support.count; ++i) {
    if ((chosen >> i & 1) != 0) kept[count++] = support.sites[i];
  }
  std::copy(kept, kept + count, support.sites);
  support.count = count;
  support.centre = best.centre;
  support.size = best.size;
  return true;
}

}  // namespace

Vector3d enclosing_centre(std::span<const Vector3d> points, double tolerance) noexcept {
  IST_ASSERT(!points.empty());
  // Coordinates are relative to one of the points, so that a small ball far out rounds like one at
  // the origin.
  const Vector3d& origin = points[0];
  const Vector3d zero = Vector3d::Zero();
  Support<Vector3d> support;
  support.sites[0] = points[farthest_from(points, origin, zero).index] - origin;
  support.sites[1] = points[farthest_from(points, origin, support.sites[0]).index] - origin;
  support.count = 2;
  support.centre = support.sites[0] + 0.5 * (support.sites[1] - support.sites[0]);
  support.size = square(support.sites[0] - support.centre);
  Farthest outside = farthest_from(points, origin, support.centre);
  Vector3d centre = support.centre;
  double least = outside.distance2;
  const double enough = (1 + tolerance) * (1 + tolerance);
  for (int pass = 0; pass < kMaxPasses && outside.distance2 > support.size * enough; ++pass) {
    if (!extend<Vector3d>(support, points[outside.index] - origin)) break;
    outside = farthest_from(points, origin, support.centre);
    if (outside.distance2 < least) {
      centre = support.centre;
      least = outside.distance2;
    }
  }
  return sum(centre, origin);
}

Ball enclosing_ball(std::span<const Vector3d> points, double tolerance) noexcept {
  const Vector3d centre = enclosing_centre(points, tolerance);
  return {centre, std::sqrt(farthest_from(points, centre, Vector3d::Zero()).distance2)};
}

bool take_in(Support<Ball>& support, const Ball& ball) noexcept { return extend(support, ball); }

}  // namespace ist
