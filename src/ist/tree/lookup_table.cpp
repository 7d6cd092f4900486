#include "ist/tree/lookup_table.h"

#include <bit>

#include "ist/tree/lookup_table_search.h"

namespace ist {
namespace {

using lookup_table_detail::corner;
using lookup_table_detail::corners_of;
using lookup_table_detail::distance_squared;
using lookup_table_detail::Point;

constexpr LookupTable kTable = lookup_table_detail::make_lookup_table();

constexpr TableBall entry(int mask) { return kTable[static_cast<std::size_t>(mask)]; }
constexpr Point centre(int mask) { return {entry(mask).x, entry(mask).y, entry(mask).z}; }

// Whether `holds(mask)` for every node with children.
template <class Predicate>
constexpr bool for_all_masks(Predicate holds) {
  for (int mask = 1; mask < 256; ++mask)
    if (!holds(mask)) return false;
  return true;
}

constexpr bool holds_its_cubes(int mask) {
  for (int i = 0; i < 27; ++i)
    if ((corners_of(mask) >> i & 1) != 0 &&
        distance_squared(corner(i), centre(mask)) > entry(mask).radius_squared)
      return false;
  return true;
}

constexpr Point minus(Point p, Point q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
constexpr Point cross(Point p, Point q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
constexpr int dot(Point p, Point q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
constexpr int determinant(Point p, Point q, Point r) { return dot(cross(p, q), r); }

// Whether the origin lies in the convex hull of the points: a segment, a triangle or a tetrahedron.
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

// A bounding ball of points is the smallest exactly if its centre lies in the convex hull of the
// points on its surface; by Carathéodory's theorem, then in the hull of two, three or four of these
// points.
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

// Applies isometry 0 … 47 of the cube: one of six orders of the axes, then one of eight
// reflections.
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

constexpr bool has_the_symmetries_of_the_cube(int mask) {
  for (int isometry = 0; isometry < 48; ++isometry) {
    const int moved = transform_mask(isometry, mask);
    if (transform(isometry, centre(mask)) != centre(moved) ||
        entry(mask).radius_squared != entry(moved).radius_squared)
      return false;
  }
  return true;
}

constexpr int smaller_than_the_circumsphere(int fewest_children, int most_children) {
  int count = 0;
  for (int mask = 1; mask < 256; ++mask) {
    const int children = std::popcount(static_cast<unsigned>(mask));
    count += children >= fewest_children && children <= most_children &&
             entry(mask).radius_squared < 108;
  }
  return count;
}

static_assert(for_all_masks(holds_its_cubes));
static_assert(for_all_masks(is_minimal));
static_assert(for_all_masks(has_the_symmetries_of_the_cube));
static_assert(for_all_masks([](int mask) { return radius_code(entry(mask)) != kNoRadiusCode; }));
static_assert(smaller_than_the_circumsphere(1, 8) == 78);
static_assert(smaller_than_the_circumsphere(5, 8) == 0);
static_assert(entry(255) == TableBall{0, 0, 0, 108});
static_assert(entry(1) == TableBall{-3, -3, -3, 27});

// Returns the square root in units of 2⁻²⁴, rounded down. Precondition: 0 <= n < 2¹⁴.
constexpr std::int64_t root(std::int64_t n) {
  std::int64_t root = 0;
  for (std::int64_t bit = std::int64_t{1} << 31; bit != 0; bit /= 2) {
    if ((root + bit) * (root + bit) <= n << 48) root += bit;
  }
  return root;
}

// Whether √p + √q <= √r, and whether √p + √q <= √r + length / 10,000, where a root that is
// rounded down may be larger by 1.
constexpr bool roots_fit(std::int64_t p, std::int64_t q, std::int64_t r) {
  return r >= p + q && 4 * p * q <= (r - p - q) * (r - p - q);
}
constexpr bool roots_fit(std::int64_t p, std::int64_t q, std::int64_t r, std::int64_t length) {
  return (root(p) + 1 + root(q) + 1) * 10'000 <= root(r) * 10'000 + (length << 24);
}

// Whether the table ball of a node at `level`, 1 or 2, larger by `excess` in 1e-4 voxels, holds
// the circumspheres of all leaves that there may be below the node. The unit is a twelfth of the
// node's half edge, in which a voxel is 12 at level 1 and 6 at level 2, and centres are integers.
constexpr bool holds_its_leaves(int mask, int level, int excess) {
  const int voxel = level == 1 ? 12 : 6, cells = 24 / voxel;
  const Point c = centre(mask);
  for (int leaf = 0; leaf < cells * cells * cells; ++leaf) {
    const int x = leaf % cells, y = leaf / cells % cells, z = leaf / cells / cells;
    const int octant = 2 * x / cells + 2 * (2 * y / cells) + 4 * (2 * z / cells);
    if ((mask >> octant & 1) == 0) continue;
    const auto place = [=](int cell) { return voxel * cell + voxel / 2 - 12; };
    const int distance2 =
        distance_squared({place(x), place(y), place(z)}, {2 * c.x, 2 * c.y, 2 * c.z});
    const int leaf_radius2 = 3 * voxel * voxel / 4, radius2 = 4 * entry(mask).radius_squared;
    if (!roots_fit(distance2, leaf_radius2, radius2) &&
        !roots_fit(distance2, leaf_radius2, radius2, voxel * excess))
      return false;
  }
  return true;
}

constexpr bool exceeds(std::size_t code, int level, int excess) {
  return !for_all_masks([=](int mask) {
    return radius_code(entry(mask)) != code || holds_its_leaves(mask, level, excess);
  });
}
static_assert([] {  // and with 1e-4 voxels less some mask's ball does not
  for (const int level : {1, 2}) {
    for (std::size_t code = 0; code < kTableSquares.size(); ++code) {
      const int excess = kLeafExcess[level == 1 ? 0 : 1][code];
      if (exceeds(code, level, excess)) return false;
      if (excess > 0 && !exceeds(code, level, excess - 1)) return false;
    }
  }
  return true;
}());

constexpr std::array<std::uint32_t, 256> kWords = [] {
  std::array<std::uint32_t, 256> words{};
  for (std::size_t mask = 0; mask < 256; ++mask) {
    words[mask] = lookup_table_detail::word_of(kTable[mask]);
  }
  return words;
}();

}  // namespace
constinit const LookupTable kLookupTable = kTable;
constinit const std::array<std::uint32_t, 256> kTableWords = kWords;

}  // namespace ist
