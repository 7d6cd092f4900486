#include "ist/query/triangles/moving_pair.h"

#include <algorithm>
#include <cmath>

#include "ist/base/ordered_vector.h"
#include "ist/query/triangles/triangle_distance.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// A time is shortened by this part, more than its rounding.
constexpr double kShorten = 1 - 0x1p-40;
// A direction turns less than this while triangles pass through each other.
constexpr double kMostTurn = 0.25;

// Returns the time in which a corner goes a gap: the root of gap = closing t + bend t².
double time_of(double gap, double closing, double bend) {
  const double root = std::sqrt(closing * closing + 4 * bend * gap);
  if (closing > 0) return 2 * gap / (closing + root);
  return bend > 0 ? (root - closing) / (2 * bend) : HUGE_VAL;
}

Vector edge_of(const TriangleCorners& t, std::size_t k) { return difference(t[(k + 1) % 3], t[k]); }
Vector normal_of(const TriangleCorners& t) {
  return cross_in_order(edge_of(t, 0), difference(t[2], t[0]));
}

// The same two triangles at two poses, between which no point goes farther than `way` and no
// direction turns by more than `turn`, rad.
struct Passage {
  const TriangleCorners &fixed, &before, &after;
  double way, turn, pad;

  // Returns the side of an edge on which a point stays, seen along n: 1 or -1; 0 if it may cross.
  [[nodiscard]] int side(const Vector& n, const Vector& edge, const Vector& to_point) const {
    const double length = length_in_order(edge);
    const double change = turn * length * (length_in_order(to_point) + way) + length * way;
    const double area = dot_in_order(n, cross_in_order(edge, to_point));
    if (!(std::abs(area) > 2 * change * length_in_order(n))) return 0;
    return area > 0 ? 1 : -1;
  }
  // Returns whether a height has changed its sign, by more than rounding.
  [[nodiscard]] bool changed(const Vector& n, const Vector& was, const Vector& m,
                             const Vector& is) const {
    const double first = dot_in_order(n, was), last = dot_in_order(m, is);
    return std::abs(first) > pad * length_in_order(n) &&
           std::abs(last) > pad * length_in_order(m) && (first > 0) != (last > 0) &&
           dot_in_order(n, m) > 0;
  }
  // Returns whether a point goes through a face. `face` and `later` are its triangle at both poses.
  [[nodiscard]] bool point_passes(const TriangleCorners& face, const Vector& point,
                                  const TriangleCorners& later, const Vector& point_later) const {
    const Vector n = normal_of(face);
    if (!changed(n, difference(point, face[0]), normal_of(later),
                 difference(point_later, later[0]))) {
      return false;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (side(n, edge_of(face, k), difference(point, face[k])) <= 0) return false;
    }
    return true;
  }
  // Returns whether edge j of the moving triangle goes through edge i of the fixed one.
  [[nodiscard]] bool edges_pass(std::size_t i, std::size_t j) const {
    const Vector &p = fixed[i], &q = before[j];
    const Vector u = edge_of(fixed, i), v = edge_of(before, j), n = cross_in_order(u, v);
    const Vector apart = difference(q, p);
    if (!changed(n, apart, cross_in_order(u, edge_of(after, j)), difference(after[j], p))) {
      return false;
    }
    const auto parted = [&](const Vector& edge, const Vector& one, const Vector& other) {
      return side(n, edge, one) * side(n, edge, other) < 0;
    };
    return parted(u, apart, sum(apart, v)) && parted(v, difference(p, q), difference(sum(p, u), q));
  }
  [[nodiscard]] bool any() const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (point_passes(fixed, before[k], fixed, after[k]) ||
          point_passes(before, fixed[k], after, fixed[k])) {
        return true;
      }
      for (std::size_t j = 0; j < 3; ++j) {
        if (edges_pass(k, j)) return true;
      }
    }
    return false;
  }
};

}  // namespace

MovingPair::MovingPair(const TriangleCorners& fixed, const TriangleCorners& moving,
                       const ScrewPart& part) noexcept
    : fixed_(fixed), moving_(moving), turning_(length_in_order(part.turning)), pad_(part.pad) {
  for (std::size_t k = 0; k < 3; ++k) {
    velocity_[k] = part.velocity(moving[k]);
    bend_[k] = turning_ > 0 ? 0.5 * turning_ * length_in_order(velocity_[k]) : 0;
  }
}

double MovingPair::time_along(const Vector& axis) const noexcept {
  const Vector& from = fixed_[0];
  double highest = 0;  // of the fixed corners
  for (std::size_t k = 1; k < 3; ++k) {
    highest = std::max(highest, dot_in_order(axis, difference(fixed_[k], from)));
  }
  const double length = length_in_order(axis);
  highest += pad_ * length;
  double time = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    const double gap = dot_in_order(axis, difference(moving_[k], from)) - highest;
    if (!(gap > 0)) return 0;
    time = std::min(time, time_of(gap, -dot_in_order(axis, velocity_[k]), bend_[k] * length));
  }
  return time * kShorten;
}

void MovingPair::try_axis(const Vector& axis, Free& best) const noexcept {
  for (const Vector& way : {axis, Vector(-axis)}) {
    const double time = time_along(way);
    if (time > best.time) best = {time, way};
  }
}

double MovingPair::quick_free_time(double enough) const noexcept {
  Free best;
  try_axis(normal_of(fixed_), best);
  if (best.time < enough) try_axis(normal_of(moving_), best);
  for (Eigen::Index i = 0; i < 3 && best.time < enough; ++i) try_axis(Vector::Unit(i), best);
  return best.time;
}

MovingPair::Free MovingPair::free_time(double enough) const noexcept {
  Free best;
  const auto done = [&](const Vector& axis) {
    try_axis(axis, best);
    return best.time >= enough;
  };
  if (done(normal_of(fixed_)) || done(normal_of(moving_))) return best;
  const NearPair nearest = closest_points(fixed_, moving_, {});
  if (done(difference(nearest.moving_point, nearest.fixed_point))) return best;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (done(cross_in_order(edge_of(fixed_, i), edge_of(moving_, j)))) return best;
    }
  }
  return best;
}

bool MovingPair::passes_until(const MovingPair& later, double time) const noexcept {
  double fastest = 0;
  for (const Vector& velocity : velocity_) fastest = std::max(fastest, length_in_order(velocity));
  const Passage passage{fixed_,          moving_, later.moving_, fastest * time + 2 * pad_,
                        turning_ * time, 2 * pad_};
  return passage.turn < kMostTurn && passage.any();
}

}  // namespace ist
