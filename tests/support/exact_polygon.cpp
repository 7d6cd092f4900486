#include "support/exact_polygon.h"

#include <algorithm>

namespace ist::test {
namespace {

// The points x with normal · x <= offset.
struct HalfSpace {
  ExactPoint normal;
  mpq_class offset;
};

bool is_zero(const ExactPoint& a) { return a == ExactPoint(); }

// Sutherland and Hodgman's clipping. In rational numbers it is exact, and holds for segments and
// points as well.
ExactPolygon cut(const ExactPolygon& polygon, const HalfSpace& half) {
  std::vector<mpq_class> beyond;
  for (const ExactPoint& p : polygon) beyond.emplace_back(dot(half.normal, p) - half.offset);
  ExactPolygon kept;
  for (std::size_t to = 0; to < polygon.size(); ++to) {
    const std::size_t from = (to == 0 ? polygon.size() : to) - 1;
    if (sgn(beyond[from]) * sgn(beyond[to]) < 0) {
      const mpq_class part = beyond[from] / (beyond[from] - beyond[to]);
      ExactPoint& crossing = kept.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) {
        crossing[i] = polygon[from][i] + part * (polygon[to][i] - polygon[from][i]);
      }
    }
    if (sgn(beyond[to]) <= 0) kept.push_back(polygon[to]);
  }
  return kept;
}

void add_equal(std::vector<HalfSpace>& halves, const ExactPoint& normal, const ExactPoint& at) {
  const mpq_class offset = dot(normal, at);
  halves.push_back({normal, offset});
  halves.push_back({mpq_class(-1) * normal, -offset});
}

// A polygon as the intersection of half spaces.
std::vector<HalfSpace> half_spaces(const ExactPolygon& polygon) {
  std::vector<HalfSpace> halves;
  const ExactPoint& first = polygon.front();
  ExactPoint normal, along;
  for (std::size_t i = 1; i < polygon.size(); ++i) {
    const ExactPoint side = polygon[i] - first;
    if (is_zero(along)) along = side;
    const ExactPoint area = cross(polygon[i - 1] - first, side);
    normal = normal + area;
  }
  if (!is_zero(normal)) {
    add_equal(halves, normal, first);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const ExactPoint& p = polygon[i];
      const ExactPoint outward = cross(polygon[(i + 1) % polygon.size()] - p, normal);
      halves.push_back({outward, dot(outward, p)});
    }
    return halves;
  }
  if (is_zero(along)) {
    for (std::size_t axis = 0; axis < 3; ++axis) add_equal(halves, unit(axis), first);
    return halves;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) add_equal(halves, cross(along, unit(axis)), first);
  mpq_class low = dot(along, first), high = low;
  for (const ExactPoint& p : polygon) {
    low = std::min<mpq_class>(low, dot(along, p));
    high = std::max<mpq_class>(high, dot(along, p));
  }
  halves.push_back({along, high});
  halves.push_back({mpq_class(-1) * along, -low});
  return halves;
}

}  // namespace

bool polygons_meet(const ExactPolygon& a, const ExactPolygon& b) {
  if (a.empty() || b.empty()) return false;
  ExactPolygon left = a;
  for (const HalfSpace& half : half_spaces(b)) {
    left = cut(left, half);
    if (left.empty()) return false;
  }
  return true;
}

}  // namespace ist::test
