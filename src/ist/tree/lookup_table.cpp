#include "ist/tree/lookup_table.h"

namespace ist {
namespace {

using lookup_table_detail::corner;
using lookup_table_detail::corners_of;
using lookup_table_detail::distance_squared;
using lookup_table_detail::Point;

constexpr TableBall entry(int mask) { return kLookupTable[static_cast<std::size_t>(mask)]; }
constexpr Point centre(int mask) { return {entry(mask).x, entry(mask).y, entry(mask).z}; }

constexpr bool every_ball_holds_its_cubes() {
  for (int mask = 1; mask < 256; ++mask) {
    for (int i = 0; i < 27; ++i) {
      if ((corners_of(mask) >> i & 1) != 0 &&
          distance_squared(corner(i), centre(mask)) > entry(mask).radius_squared) {
        return false;
      }
    }
  }
  return true;
}

constexpr Point minus(Point p, Point q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
constexpr Point cross(Point p, Point q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
constexpr int dot(Point p, Point q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
constexpr int determinant(Point p, Point q, Point r) { return dot(cross(p, q), r); }

// Whether the origin lies between, within the triangle or the tetrahedron of the points.
constexpr bool surround(Point p, Point q) {
  const Point normal = cross(p, q);
  return dot(normal, normal) == 0 && dot(p, q) < 0;
}
constexpr bool surround(Point p, Point q, Point r) {
  const Point a = cross(p, q), b = cross(q, r), c = cross(r, p);
  const Point sum{a.x + b.x + c.x, a.y + b.y + c.y, a.z + b.z + c.z};
  return determinant(p, q, r) == 0 && dot(sum, sum) > 0 && dot(a, b) >= 0 && dot(b, c) >= 0 &&
         dot(c, a) >= 0;
}
constexpr bool surround(Point p, Point q, Point r, Point s) {
  const int a = determinant(q, r, s), b = -determinant(p, r, s), c = determinant(p, q, s),
            d = -determinant(p, q, r);
  if (a + b + c + d == 0) return false;
  return (a >= 0 && b >= 0 && c >= 0 && d >= 0) || (a <= 0 && b <= 0 && c <= 0 && d <= 0);
}

// A ball that holds points is the smallest exactly if its centre lies in the convex hull of those
// on its surface; by Carathéodory's theorem, then in that of two, three or four of them.
constexpr bool is_minimal(int mask) {
  Point support[27] = {};
  int n = 0;
  for (int i = 0; i < 27; ++i) {
    if ((corners_of(mask) >> i & 1) != 0 &&
        distance_squared(corner(i), centre(mask)) == entry(mask).radius_squared) {
      support[n++] = minus(corner(i), centre(mask));
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (surround(support[i], support[j])) return true;
      for (int k = j + 1; k < n; ++k) {
        if (surround(support[i], support[j], support[k])) return true;
        for (int l = k + 1; l < n; ++l) {
          if (surround(support[i], support[j], support[k], support[l])) return true;
        }
      }
    }
  }
  return false;
}

constexpr bool every_ball_is_minimal() {
  for (int mask = 1; mask < 256; ++mask) {
    if (!is_minimal(mask)) return false;
  }
  return true;
}

// Isometry 0 … 47 of the cube: one of six orders of the axes, then one of eight mirrorings.
constexpr Point transform(int isometry, Point p) {
  constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const int coordinates[3] = {p.x, p.y, p.z};
  int moved[3] = {};
  for (int i = 0; i < 3; ++i) {
    moved[i] = coordinates[kOrders[isometry / 8][i]] * ((isometry >> i & 1) != 0 ? -1 : 1);
  }
  return {moved[0], moved[1], moved[2]};
}

constexpr int transform_mask(int isometry, int mask) {
  int moved = 0;
  for (int octant = 0; octant < 8; ++octant) {
    if ((mask >> octant & 1) == 0) continue;
    const Point p = transform(
        isometry, {2 * (octant & 1) - 1, 2 * (octant >> 1 & 1) - 1, 2 * (octant >> 2) - 1});
    moved |= 1 << ((p.x > 0) + 2 * (p.y > 0) + 4 * (p.z > 0));
  }
  return moved;
}

constexpr bool has_the_symmetries_of_the_cube() {
  for (int isometry = 0; isometry < 48; ++isometry) {
    for (int mask = 1; mask < 256; ++mask) {
      const Point moved = transform(isometry, centre(mask));
      const int moved_mask = transform_mask(isometry, mask);
      if (minus(moved, centre(moved_mask)).x != 0 || minus(moved, centre(moved_mask)).y != 0 ||
          minus(moved, centre(moved_mask)).z != 0 ||
          entry(mask).radius_squared != entry(moved_mask).radius_squared) {
        return false;
      }
    }
  }
  return true;
}

constexpr int smaller_than_the_circumsphere(int fewest_children, int most_children) {
  int count = 0;
  for (int mask = 1; mask < 256; ++mask) {
    int children = 0;
    for (int octant = 0; octant < 8; ++octant) children += mask >> octant & 1;
    count += children >= fewest_children && children <= most_children &&
             entry(mask).radius_squared < 108;
  }
  return count;
}

constexpr bool has_five_radii() {
  for (int mask = 1; mask < 256; ++mask) {
    const int r2 = entry(mask).radius_squared;
    if (r2 != 27 && r2 != 54 && r2 != 81 && r2 != 96 && r2 != 108) return false;
  }
  return true;
}

static_assert(every_ball_holds_its_cubes());
static_assert(every_ball_is_minimal());
static_assert(has_the_symmetries_of_the_cube());
static_assert(has_five_radii());
static_assert(smaller_than_the_circumsphere(1, 8) == 78);
static_assert(smaller_than_the_circumsphere(5, 8) == 0);
static_assert(entry(255) == TableBall{0, 0, 0, 108});
static_assert(entry(1) == TableBall{-3, -3, -3, 27});

}  // namespace
}  // namespace ist
