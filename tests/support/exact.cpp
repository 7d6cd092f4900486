#include "support/exact.h"

#include <algorithm>
#include <optional>

namespace ist::test {
namespace {

// Cuts away what lies beyond a plane: above it for side = 1, below it for side = -1.
ExactPolygon cut(const ExactPolygon& polygon, std::size_t axis, const mpq_class& plane, int side) {
  ExactPolygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ExactPoint &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const mpq_class from_beyond = side * (from[axis] - plane);
    const mpq_class to_beyond = side * (to[axis] - plane);
    if (from_beyond <= 0) kept.push_back(from);
    if (from_beyond * to_beyond < 0) {
      kept.push_back(from + mpq_class(from_beyond / (from_beyond - to_beyond)) * (to - from));
    }
  }
  return kept;
}

mpq_class distance_squared(const ExactPoint& point, const ExactPoint& a, const ExactPoint& b) {
  const ExactPoint along = b - a;
  const mpq_class length_squared = square(along);
  if (length_squared == 0) return square(point - a);
  const mpq_class part = dot(point - a, along) / length_squared;
  return square(point - (a + std::clamp<mpq_class>(part, 0, 1) * along));
}

// The smallest ball with all the points on its surface, or nothing if there is none. Its centre
// is p0 + Σ xᵢ dᵢ, dᵢ = pᵢ - p0, and |centre - pᵢ| = |centre - p0| makes Σⱼ 2 dᵢ·dⱼ xⱼ = dᵢ·dᵢ.
std::optional<ExactBall> ball_through(const std::vector<ExactPoint>& points) {
  const std::size_t n = points.size() - 1;
  std::vector<ExactPoint> d(n);
  for (std::size_t i = 0; i < n; ++i) d[i] = points[i + 1] - points[0];
  std::vector<std::vector<mpq_class>> rows(n, std::vector<mpq_class>(n + 1));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) rows[i][j] = 2 * dot(d[i], d[j]);
    rows[i][n] = square(d[i]);
  }
  for (std::size_t i = 0; i < n; ++i) {  // Gauss and Jordan; the matrix is positive definite or
    if (rows[i][i] == 0) return std::nullopt;  // the points are not independent
    for (std::size_t other = 0; other < n; ++other) {
      if (other == i) continue;
      const mpq_class factor = rows[other][i] / rows[i][i];
      for (std::size_t j = i; j <= n; ++j) rows[other][j] -= factor * rows[i][j];
    }
  }
  ExactPoint centre = points[0];
  for (std::size_t i = 0; i < n; ++i) centre = centre + mpq_class(rows[i][n] / rows[i][i]) * d[i];
  return ExactBall{centre, square(centre - points[0])};
}

struct CellRange {
  std::uint32_t begin, end;
};

// The cells whose slab of the axis meets the piece: k·s - grow <= highest, (k + 1)·s + grow >= low.
CellRange cell_range(const ExactPolygon& polygon, std::size_t axis, const Lattice& lattice,
                     const mpq_class& grow) {
  mpq_class low = polygon[0][axis], high = low;
  for (const ExactPoint& p : polygon) {
    low = std::min(low, p[axis]);
    high = std::max(high, p[axis]);
  }
  const mpq_class corner(lattice.corner[axis]), size(lattice.voxel_size);
  const mpz_class cells = lattice.cells;
  const mpz_class first = -floor_of((corner + grow - low) / size) - 1;  // ceil(x) = -floor(-x)
  const mpz_class end = floor_of((high + grow - corner) / size) + 1;
  const mpz_class begin_inside = std::clamp<mpz_class>(first, 0, cells);
  const mpz_class end_inside = std::clamp<mpz_class>(end, 0, cells);
  return {static_cast<std::uint32_t>(begin_inside.get_ui()),
          static_cast<std::uint32_t>(end_inside.get_ui())};
}

}  // namespace

ExactPoint unit(std::size_t axis) {
  ExactPoint direction;
  direction[axis] = 1;
  return direction;
}

mpz_class floor_of(const mpq_class& x) {
  mpz_class result;
  mpz_fdiv_q(result.get_mpz_t(), x.get_num_mpz_t(), x.get_den_mpz_t());
  return result;
}

ExactPoint operator+(const ExactPoint& a, const ExactPoint& b) {
  return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}};
}
ExactPoint operator-(const ExactPoint& a, const ExactPoint& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}
ExactPoint operator*(const mpq_class& factor, const ExactPoint& a) {
  return {{factor * a[0], factor * a[1], factor * a[2]}};
}
mpq_class dot(const ExactPoint& a, const ExactPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
ExactPoint cross(const ExactPoint& a, const ExactPoint& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
mpq_class square(const ExactPoint& a) { return dot(a, a); }

ExactPoint exact(const Eigen::Vector3d& point) {
  return {{mpq_class(point[0]), mpq_class(point[1]), mpq_class(point[2])}};
}

ExactPolygon exact_triangle(const std::array<Eigen::Vector3d, 3>& corners) {
  return {exact(corners[0]), exact(corners[1]), exact(corners[2])};
}

ExactPolygon exact_triangle(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return exact_triangle({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
}

ExactPolygon clip_between(const ExactPolygon& polygon, std::size_t axis, const mpq_class& low,
                          const mpq_class& high) {
  return cut(cut(polygon, axis, high, 1), axis, low, -1);
}

ExactPolygon clip(const ExactPolygon& polygon, const ExactBox& box) {
  ExactPolygon inside = polygon;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    inside = clip_between(inside, axis, box.low[axis], box.high[axis]);
  }
  return inside;
}

mpq_class distance_squared(const ExactPoint& point, const ExactPolygon& triangle) {
  const ExactPoint &a = triangle[0], &b = triangle[1], &c = triangle[2];
  const ExactPoint normal = cross(b - a, c - a);
  if (square(normal) != 0) {
    const auto within = [&](const ExactPoint& from, const ExactPoint& to) {
      return dot(cross(to - from, point - from), normal) >= 0;
    };
    if (within(a, b) && within(b, c) && within(c, a)) {
      const mpq_class height = dot(point - a, normal);
      return height * height / square(normal);
    }
  }
  return std::min({distance_squared(point, a, b), distance_squared(point, b, c),
                   distance_squared(point, c, a)});
}

// A ball that is smallest for some of the points and holds all is smallest for all. Its radius
// grows with each point taken in, so the loop ends.
ExactBall smallest_ball(const std::vector<ExactPoint>& points) {
  std::vector<ExactPoint> support{points[0]};
  ExactBall ball{points[0], 0};
  for (;;) {
    const ExactPoint* farthest = nullptr;
    mpq_class largest = ball.radius_squared;
    for (const ExactPoint& p : points) {
      const mpq_class distance = square(p - ball.centre);
      if (distance <= largest) continue;
      largest = distance;
      farthest = &p;
    }
    if (farthest == nullptr) return ball;
    support.push_back(*farthest);  // at most five, and four are enough
    std::optional<ExactBall> best;
    std::vector<ExactPoint> best_support;
    for (unsigned chosen = 1; chosen < 1u << support.size(); ++chosen) {
      std::vector<ExactPoint> some;
      for (std::size_t i = 0; i < support.size(); ++i) {
        if ((chosen >> i & 1) != 0) some.push_back(support[i]);
      }
      if (some.size() > 4) continue;
      const std::optional<ExactBall> through = ball_through(some);
      if (!through || (best && through->radius_squared >= best->radius_squared)) continue;
      if (std::all_of(support.begin(), support.end(), [&](const ExactPoint& p) {
            return square(p - through->centre) <= through->radius_squared;
          })) {
        best = through;
        best_support = some;
      }
    }
    ball = *best;
    support = best_support;
  }
}

mpq_class exact_pad(const Lattice& lattice) {
  return mpq_class(1, 1'000'000'000) * lattice.cells * mpq_class(lattice.voxel_size);
}

ExactBox node_cube(const Lattice& lattice, int level, std::uint64_t code) {
  ExactBox cube;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mpz_class index = 0;
    for (unsigned bit = 0; bit < 16; ++bit) {
      if ((code >> (3 * bit + axis) & 1) != 0) index += mpz_class(1) << bit;
    }
    const mpq_class corner(lattice.corner[axis]), size(lattice.voxel_size);
    const mpz_class edge = mpz_class(1) << static_cast<unsigned>(level);
    cube.low[axis] = corner + mpq_class(index * edge) * size;
    cube.high[axis] = corner + mpq_class((index + 1) * edge) * size;
  }
  return cube;
}

ExactBox grown(ExactBox box, const mpq_class& by) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] -= by;
    box.high[axis] += by;
  }
  return box;
}

ExactPoint frame_origin(const Lattice& lattice) {
  const ExactBox root = node_cube(lattice, lattice.depth, 0);
  return mpq_class(1, 2) * (root.low + root.high);
}

std::vector<std::uint64_t> cells_met(const ExactPolygon& polygon, const Lattice& lattice,
                                     const mpq_class& grow) {
  const mpq_class size(lattice.voxel_size);
  const auto slab = [&](const ExactPolygon& piece, std::size_t axis, std::uint32_t index) {
    const mpq_class low = mpq_class(lattice.corner[axis]) + index * size;
    return clip_between(piece, axis, low - grow, low + size + grow);
  };
  std::vector<std::uint64_t> codes;
  const CellRange layers = cell_range(polygon, 2, lattice, grow);
  for (std::uint32_t z = layers.begin; z < layers.end; ++z) {
    const ExactPolygon layer = slab(polygon, 2, z);
    const CellRange rows = cell_range(layer, 1, lattice, grow);
    for (std::uint32_t y = rows.begin; y < rows.end; ++y) {
      // A convex polygon meets all cells between its ends.
      const CellRange row = cell_range(slab(layer, 1, y), 0, lattice, grow);
      for (std::uint32_t x = row.begin; x < row.end; ++x) {
        std::uint64_t code = 0;
        for (unsigned bit = 0; bit < 16; ++bit) {
          code |= std::uint64_t{x >> bit & 1} << 3 * bit |
                  std::uint64_t{y >> bit & 1} << (3 * bit + 1) |
                  std::uint64_t{z >> bit & 1} << (3 * bit + 2);
        }
        codes.push_back(code);
      }
    }
  }
  std::sort(codes.begin(), codes.end());
  return codes;
}

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
