#include "ist/measure/support_hull.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// A hull that is thinner than this part of its width is a line.
constexpr double kThin = 1e-6;

}  // namespace

// Source of the hull: A. M. Andrew, Another efficient algorithm for convex hulls in two dimensions,
// Information Processing Letters 9(5), 1979.
SupportHull::SupportHull(std::span<const Vector> points, const Vector& direction) {
  // The axis that is most across the direction.
  Eigen::Index least = 0;
  for (Eigen::Index i = 1; i < 3; ++i) {
    if (std::abs(direction[i]) < std::abs(direction[least])) least = i;
  }
  Vector u = cross_in_order(direction, Vector::Unit(least));
  u = scaled(1 / length_in_order(u), u);
  const Vector v = cross_in_order(direction, u);
  std::vector<Point> all;
  for (const Vector& point : points) {
    all.push_back({dot_in_order(u, point), dot_in_order(v, point)});
  }
  const auto before = [](const Point& a, const Point& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  };
  std::sort(all.begin(), all.end(), before);
  const auto add = [&](const Point& point, std::size_t from) {
    const auto turns_left = [&] {
      const Point &a = hull_[hull_.size() - 2], &b = hull_.back();
      return (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x) > 0;
    };
    while (hull_.size() >= from + 2 && !turns_left()) hull_.pop_back();
    hull_.push_back(point);
  };
  for (const Point& point : all) add(point, 0);
  const std::size_t upper = hull_.empty() ? 0 : hull_.size() - 1;
  for (std::size_t i = all.size(); i-- > 1;) add(all[i - 1], upper);
  if (hull_.size() > 1) hull_.pop_back();  // the first point came back
}

double SupportHull::margin() const noexcept {
  double inside = std::numeric_limits<double>::infinity();  // from the lines of the sides
  double nearest = inside, width = 0, depth = 0;
  for (std::size_t i = 0; i < hull_.size(); ++i) {
    const Point &a = hull_[i], &b = hull_[(i + 1) % hull_.size()];
    const double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    const double along = square > 0 ? std::clamp(-(a.x * x + a.y * y) / square, 0.0, 1.0) : 0.0;
    const double px = a.x + along * x, py = a.y + along * y;
    nearest = std::min(nearest, std::sqrt(px * px + py * py));
    if (!(square > 0)) continue;
    const double length = std::sqrt(square);
    inside = std::min(inside, (y * a.x - x * a.y) / length);
    width = std::max(width, length);
    double farthest = 0;  // of the hull from this side
    for (const Point& c : hull_) {
      farthest = std::max(farthest, (x * (c.y - a.y) - y * (c.x - a.x)) / length);
    }
    depth = depth > 0 ? std::min(depth, farthest) : farthest;
  }
  const bool is_line = hull_.size() < 3 || !(depth > kThin * width);
  if (hull_.empty()) return -nearest;
  return !is_line && inside >= 0 ? nearest : -nearest;
}

}  // namespace ist
