#include "ist/measure/outer_ball_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "ist/base/float_rounding.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"
#include "ist/base/throw_error.h"
#include "ist/measure/point_search.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;
using Cell = std::array<std::int32_t, 3>;

constexpr double kCellOfEdge = 1.5;        // cells, as a part of √(mean area)
constexpr double kLargestCell = 1.0 / 32;  // as a part of the longest edge of the box
constexpr double kBytesOfTriangle = 28;
constexpr double kLeastBytes = 1 << 20;
constexpr double kLargestRadius = 8, kBand = 3;  // in cells
constexpr double kSeedCell = 0.5, kSampleStep = 0.7;
constexpr int kShrinks = 4;   // balls that are tried at a seed
constexpr int kSpreads = 12;  // cells that a ball may travel from neighbour to neighbour
constexpr std::size_t kSeedsAtOnce = 512, kCellsAtOnce = 512;
// More than the error of a distance, as a part of the coordinates.
constexpr double kDistanceRounding = 0x1p-36;
constexpr float kNoBound = std::numeric_limits<float>::infinity();

std::int32_t floor_of(double value) { return static_cast<std::int32_t>(std::floor(value)); }

// The corners of a triangle from its longest edge on, and the samples along that edge and across.
struct Sampled {
  std::array<Vector, 3> corner;
  std::uint32_t along, across;

  Sampled(const TriangleMesh& mesh, std::uint32_t triangle, double step) {
    const Triangle& t = mesh.triangles[triangle];
    double longest = -1;
    std::size_t from = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double square =
          square_in_order(difference(mesh.vertices[t[(k + 1) % 3]], mesh.vertices[t[k]]));
      if (square > longest) from = k;
      longest = std::max(longest, square);
    }
    for (std::size_t k = 0; k < 3; ++k) corner[k] = mesh.vertices[t[(from + k) % 3]];
    const double edge = std::sqrt(longest);
    const double twice_area = length_in_order(normal());
    along = parts(edge, step);
    across = parts(edge > 0 ? twice_area / edge : 0, step);
  }
  [[nodiscard]] std::uint64_t count() const { return std::uint64_t{along} * across; }
  [[nodiscard]] Vector normal() const {
    return cross_in_order(difference(corner[1], corner[0]), difference(corner[2], corner[0]));
  }
  [[nodiscard]] Vector point(std::uint32_t number) const {
    if (count() == 1) return scaled(1.0 / 3, sum(sum(corner[0], corner[1]), corner[2]));
    const double v = (number / along + 0.5) / across;
    const double u = (number % along + 0.5) / along * (1 - v);
    return sum(corner[0], sum(scaled(u, difference(corner[1], corner[0])),
                              scaled(v, difference(corner[2], corner[0]))));
  }

 private:
  static std::uint32_t parts(double length, double step) {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(length / step), 1.0, 65535.0));
  }
};

// A place on the surface that a ball may touch.
struct Seed {
  std::uint64_t key;  // of its cube and its normal's main direction
  float off_centre;   // the square of the distance from the cube's centre, in cubes
  std::uint32_t triangle, number;

  friend bool operator<(const Seed& a, const Seed& b) {
    return std::tie(a.key, a.off_centre, a.triangle, a.number) <
           std::tie(b.key, b.off_centre, b.triangle, b.number);
  }
};

// A ball that touches the surface at `on`, whose outer normal there is `normal`; units.
struct Touching {
  OuterBall ball;
  Vector on, normal;
};

class Builder {
 public:
  Builder(const SphereTree& tree, Progress* progress)
      : mesh_(*tree.triangles()),
        body_(*parts_of(tree).triangles),
        search_(tree, select_kernels({}).clusters),
        size_(tree.bounding_radius() + tree.origin().cwiseAbs().maxCoeff()),
        progress_(progress) {
    const Eigen::AlignedBox3d& box = body_.box();
    sizes_ = difference(box.max(), box.min());
    longest_ = sizes_.maxCoeff();
    field_.middle = sum(box.min(), scaled(0.5, sizes_));
  }

  OuterBalls build(std::uint64_t max_memory) {
    choose_cells(max_memory);
    begin("placing outer balls", seeds_.size());
    place_balls();
    begin("painting outer balls", field_.groups[2]);
    paint();
    spread();
    fill();
    return std::move(field_);
  }

 private:
  void begin(const char* name, std::uint64_t total) const {
    if (progress_ == nullptr) return;
    progress_->check();
    progress_->begin_stage(name, total);
  }
  void step(std::uint64_t done) const {
    if (progress_ == nullptr) return;
    progress_->check();
    progress_->add(done);
  }
  [[nodiscard]] Vector in_units(const Vector& p) const {
    return scaled(1 / field_.unit, difference(p, field_.middle));
  }
  [[nodiscard]] Vector in_mesh(const Vector& p) const {
    return sum(field_.middle, scaled(field_.unit, p));
  }
  [[nodiscard]] double edge() const { return double{field_.cell}; }
  [[nodiscard]] std::int32_t cells(std::size_t axis) const {
    return static_cast<std::int32_t>(OuterBalls::kGroup * field_.groups[axis]);
  }
  [[nodiscard]] Cell cell_of(const Vector& p) const {
    Cell cell;
    for (std::size_t i = 0; i < 3; ++i) {
      cell[i] = floor_of((p[static_cast<Eigen::Index>(i)] - double{field_.low(i)}) / edge());
    }
    return cell;
  }
  [[nodiscard]] Vector centre_of(const Cell& cell, double half = 0.5) const {
    Vector centre;
    for (std::size_t i = 0; i < 3; ++i) {
      centre[static_cast<Eigen::Index>(i)] = double{field_.low(i)} + edge() * (cell[i] + half);
    }
    return centre;
  }
  [[nodiscard]] std::size_t group_of(const Cell& cell) const {
    const auto at = [&](std::size_t i) {
      return static_cast<std::size_t>(cell[i]) / OuterBalls::kGroup;
    };
    return (at(2) * field_.groups[1] + at(1)) * field_.groups[0] + at(0);
  }
  [[nodiscard]] bool is_in_grid(const Cell& cell) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (cell[i] < 0 || cell[i] >= cells(i)) return false;
    }
    return true;
  }
  [[nodiscard]] std::size_t ball_at(const Cell& cell) const {
    return field_.ball_at(static_cast<std::uint32_t>(cell[0]), static_cast<std::uint32_t>(cell[1]),
                          static_cast<std::uint32_t>(cell[2]));
  }

  void choose_cells(std::uint64_t max_memory);
  void set_cell(double edge);
  void find_seeds();
  [[nodiscard]] std::size_t mark_groups();
  template <class Body>
  void for_each_cell(const Vector& on, const Vector& normal, std::int32_t low_z,
                     std::int32_t high_z, const Body& body) const;

  struct Place {
    double radius;  // units; 0: inside, unknown or too near
    NearestTriangle nearest;
    bool is_outside;
  };
  [[nodiscard]] Place look(const Vector& at, std::optional<std::uint32_t>& hint) const;
  [[nodiscard]] static Vector whole(const Vector& at);
  [[nodiscard]] static OuterBall ball_of(const Vector& at, double radius);
  struct Tried {
    OuterBall ball;
    double bound = HUGE_VAL;
  };
  [[nodiscard]] Tried shrink(const Vector& on, const Vector& normal, const Vector& about,
                             double spread, std::optional<std::uint32_t>& hint) const;
  void place_balls();
  void paint();
  void take(const OuterBall& ball, const Vector& centre, double spread, std::size_t at);
  void spread();
  void fill();
  [[nodiscard]] OuterBall far_ball() const;
  [[nodiscard]] OuterBall own_ball(const Vector& centre, double spread,
                                   std::optional<std::uint32_t>& hint) const;

  const TriangleMesh& mesh_;
  const TreeTriangles& body_;
  const PointSearch search_;
  const double size_;
  Progress* const progress_;
  Vector sizes_;
  double longest_;
  OuterBalls field_;
  std::vector<Seed> seeds_;
  double sample_step_ = 0;
  std::vector<std::uint8_t> is_split_;  // of each group
  std::vector<Touching> touching_;
  std::vector<float> bound_;  // of each ball for a piece of its cell
};

void Builder::set_cell(double cell) {
  // Balls lie within 24 cells of the box: their centres fit 16 bits.
  int exponent = 0;
  static_cast<void>(std::frexp((0.5 * longest_ + 24 * cell) / 32000, &exponent));
  field_.unit = std::ldexp(1.0, exponent);
  field_.cell = static_cast<float>(cell / field_.unit);
  const double group = OuterBalls::kGroup * edge();
  for (std::size_t i = 0; i < 3; ++i) {
    const double size = sizes_[static_cast<Eigen::Index>(i)] / field_.unit;
    field_.half[i] = rounded_up(0.5 * size + kDistanceRounding * size_ / field_.unit);
    field_.groups[i] = static_cast<std::uint32_t>(std::ceil((size + 2 * edge()) / group));
  }
}

void Builder::choose_cells(std::uint64_t max_memory) {
  double area = 0;
  for (const Triangle& t : mesh_.triangles) {
    const auto& v = mesh_.vertices;
    area += 0.5 * length_in_order(
                      cross_in_order(difference(v[t[1]], v[t[0]]), difference(v[t[2]], v[t[0]])));
  }
  const auto count = static_cast<double>(mesh_.triangles.size());
  const double most =
      std::min(std::max(kBytesOfTriangle * count, kLeastBytes), static_cast<double>(max_memory));
  const double least_cell = longest_ / (64 + 4 * std::sqrt(count));
  double cell =
      std::clamp(kCellOfEdge * std::sqrt(area / count), least_cell, kLargestCell * longest_);
  for (double bytes = 0;; cell *= std::max(1.02, std::sqrt(bytes / most))) {
    if (cell > longest_) {
      throw_error(ErrorCode::kMemoryLimit,
                  "outer balls need more than the {} bytes that are allowed: allow more memory, or "
                  "ask for depths without them",
                  max_memory);
    }
    set_cell(cell);
    double groups = 1;
    for (const std::uint32_t along : field_.groups) groups *= along;
    bytes = groups * (sizeof(std::int32_t) + sizeof(OuterBall));
    if (bytes > most) continue;
    find_seeds();
    bytes = static_cast<double>(mark_groups());
    if (bytes <= most) return;
  }
}

// Returns the main direction of a normal, 0 … 5: both sides of a thin wall get balls.
std::uint64_t main_direction(const Vector& normal) {
  Eigen::Index axis = 0;
  for (Eigen::Index i = 1; i < 3; ++i) {
    if (std::abs(normal[i]) > std::abs(normal[axis])) axis = i;
  }
  return 2 * static_cast<std::uint64_t>(axis) + (normal[axis] < 0 ? 1 : 0);
}

void Builder::find_seeds() {
  const auto count = static_cast<std::uint32_t>(mesh_.triangles.size());
  // Needles as long as the body would have too many samples.
  const std::uint64_t most = 8 * std::uint64_t{count} + 200'000;
  sample_step_ = kSampleStep * edge() * field_.unit;
  for (;; sample_step_ *= 2) {
    std::uint64_t samples = 0;
    for (std::uint32_t t = 0; t < count; ++t) samples += Sampled(mesh_, t, sample_step_).count();
    if (samples <= most) break;
  }
  seeds_.clear();
  const double cube = kSeedCell * edge();
  for (std::uint32_t t = 0; t < count; ++t) {
    const Sampled sampled(mesh_, t, sample_step_);
    const Vector normal = sampled.normal();
    if (!(length_in_order(normal) > 0)) continue;
    const std::uint64_t direction = main_direction(normal);
    for (std::uint32_t number = 0; number < sampled.count(); ++number) {
      const Vector at = in_units(sampled.point(number));
      std::uint64_t key = 0;
      double off = 0;
      for (std::size_t i = 3; i-- > 0;) {
        const double place = (at[static_cast<Eigen::Index>(i)] - double{field_.low(i)}) / cube;
        const double whole = std::floor(place), rest = (place - whole) - 0.5;
        key = key << 20 | static_cast<std::uint64_t>(std::max(whole, 0.0));
        off += rest * rest;
      }
      seeds_.push_back({key * 6 + direction, static_cast<float>(off), t, number});
    }
  }
  std::sort(seeds_.begin(), seeds_.end());
  const auto end = std::unique(seeds_.begin(), seeds_.end(),
                               [](const Seed& a, const Seed& b) { return a.key == b.key; });
  seeds_.erase(end, seeds_.end());
}

// Calls `body(cell)` for the cells beside the normal at a point of the surface, on both sides, at
// the heights [low_z, high_z).
template <class Body>
void Builder::for_each_cell(const Vector& on, const Vector& normal, std::int32_t low_z,
                            std::int32_t high_z, const Body& body) const {
  const double reach = kBand * edge();
  const auto steps = static_cast<int>(2 * kBand);
  Cell last{-9, -9, -9};
  for (int k = 0; k <= steps; ++k) {
    const Cell at = cell_of(sum(on, scaled(reach - k * edge(), normal)));
    if (at == last) continue;
    // Its neighbours have been called.
    const auto is_beside_last = [&last](const Cell& cell) {
      return std::abs(cell[0] - last[0]) <= 1 && std::abs(cell[1] - last[1]) <= 1 &&
             std::abs(cell[2] - last[2]) <= 1;
    };
    const auto begin = [&](std::size_t i) { return std::max(0, at[i] - 1); };
    const auto end = [&](std::size_t i) { return std::min(cells(i), at[i] + 2); };
    for (std::int32_t z = std::max(begin(2), low_z); z < std::min(end(2), high_z); ++z) {
      for (std::int32_t y = begin(1); y < end(1); ++y) {
        for (std::int32_t x = begin(0); x < end(0); ++x) {
          const Cell cell{x, y, z};
          if (!is_beside_last(cell)) body(cell);
        }
      }
    }
    last = at;
  }
}

// Splits the groups that balls of seeds reach. Returns the bytes of such a field.
std::size_t Builder::mark_groups() {
  const std::size_t groups = std::size_t{field_.groups[0]} * field_.groups[1] * field_.groups[2];
  is_split_.assign(groups, 0);
  for (const Seed& seed : seeds_) {
    const Sampled sampled(mesh_, seed.triangle, sample_step_);
    const Vector normal = sampled.normal();
    for_each_cell(in_units(sampled.point(seed.number)), scaled(1 / length_in_order(normal), normal),
                  0, cells(2), [&](const Cell& cell) { is_split_[group_of(cell)] = 1; });
  }
  field_.first.resize(groups);
  std::size_t count = 0;
  for (std::size_t group = 0; group < groups; ++group) {
    field_.first[group] = static_cast<std::int32_t>(2 * count + is_split_[group]);
    count += is_split_[group] != 0 ? OuterBalls::kGroupCells : 1;
  }
  const std::size_t bytes = groups * sizeof(std::int32_t) + count * sizeof(OuterBall);
  constexpr std::size_t kMostBalls = std::size_t{1} << 28;
  return count < kMostBalls ? bytes : std::numeric_limits<std::size_t>::max();
}

Vector Builder::whole(const Vector& at) {
  return {std::round(at[0]), std::round(at[1]), std::round(at[2])};
}

OuterBall Builder::ball_of(const Vector& at, double radius) {
  return {{static_cast<std::int32_t>(at[0]), static_cast<std::int32_t>(at[1]),
           static_cast<std::int32_t>(at[2])},
          static_cast<std::uint32_t>(radius)};
}

// Measures the largest ball round a point, units.
Builder::Place Builder::look(const Vector& at, std::optional<std::uint32_t>& hint) const {
  const Vector point = in_mesh(at);
  const NearestTriangle nearest = *search_.nearest(point, HUGE_VAL, hint);
  hint = nearest.triangle;
  const bool is_outside = body_.side_of(point, nearest) == Side::kOutside;
  const double rounding = kDistanceRounding * (size_ + point.cwiseAbs().maxCoeff());
  const double radius = std::floor((std::sqrt(nearest.square) - rounding) / field_.unit);
  const double most = OuterBall::kMostRadius;
  return {is_outside && radius > 0 ? std::min(radius, most) : 0, nearest, is_outside};
}

// Returns the bound of a ball for a piece of this radius about a point.
double bound_of(const OuterBall& ball, const Vector& about, double spread) {
  const Vector way = difference(about, Vector(ball.x(), ball.y(), ball.z()));
  return std::sqrt(square_in_order(way) + spread * spread) - ball.radius();
}

// Tries balls that touch the surface at a point, from large to small. Returns the one with the
// least bound about a point.
Builder::Tried Builder::shrink(const Vector& on, const Vector& normal, const Vector& about,
                               double spread, std::optional<std::uint32_t>& hint) const {
  Tried best;
  double radius = kLargestRadius * edge();
  for (int k = 0; k < kShrinks; ++k) {
    const Vector at = whole(sum(on, scaled(radius, normal)));
    const Place place = look(at, hint);
    if (place.radius > 0) {
      const OuterBall ball = ball_of(at, place.radius);
      const double bound = bound_of(ball, about, spread);
      if (bound < best.bound) best = {ball, bound};
    }
    if (place.is_outside && place.radius + 1 > radius - 0.03 * edge()) break;
    // The ball through the nearest point, a little larger.
    const Vector way = difference(in_units(place.nearest.on.point), on);
    const double along = dot_in_order(normal, way);
    const double next = along > 0 ? 1.02 * square_in_order(way) / (2 * along) : 0.5 * radius;
    radius = std::min(next, 0.7 * radius);
    if (radius < 0.05 * edge()) break;
  }
  return best;
}

void Builder::place_balls() {
  std::vector<std::optional<Touching>> made(seeds_.size());
  parallel_for(seeds_.size(), kSeedsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Sampled sampled(mesh_, seeds_[i].triangle, sample_step_);
      Vector normal = sampled.normal();
      normal = scaled(1 / length_in_order(normal), normal);
      const Vector on = in_units(sampled.point(seeds_[i].number));
      std::optional<std::uint32_t> hint = seeds_[i].triangle;
      const Tried tried = shrink(on, normal, on, 0.5 * edge(), hint);
      if (tried.bound < HUGE_VAL) made[i] = Touching{tried.ball, on, normal};
    }
    step(end - begin);
  });
  for (const std::optional<Touching>& one : made) {
    if (one) touching_.push_back(*one);
  }
  seeds_ = {};
}

void Builder::take(const OuterBall& ball, const Vector& centre, double spread, std::size_t at) {
  const auto bound = static_cast<float>(bound_of(ball, centre, spread));
  if (!(bound < bound_[at])) return;
  bound_[at] = bound;
  field_.balls[at] = ball;
}

// A ball that lies beside the body: true for every cell, and hardly of use.
OuterBall Builder::far_ball() const {
  const double apart = double{OuterBall::kMostCoordinate} - double{field_.half[0]};
  return ball_of({double{OuterBall::kMostCoordinate}, 0, 0}, std::max(0.0, std::floor(apart) - 1));
}

void Builder::paint() {
  const std::size_t last = is_split_.size() - 1;
  const std::size_t count = static_cast<std::size_t>(field_.first[last] / 2) +
                            (is_split_[last] != 0 ? OuterBalls::kGroupCells : 1);
  field_.balls.assign(count, far_ball());
  bound_.assign(count, kNoBound);
  parallel_for(field_.groups[2], 1, [&](std::size_t begin, std::size_t end) {
    const auto low = static_cast<std::int32_t>(begin * OuterBalls::kGroup);
    const auto high = static_cast<std::int32_t>(end * OuterBalls::kGroup);
    for (const Touching& one : touching_) {
      const double z = (one.on[2] - double{field_.low(2)}) / edge();
      if (z + kBand + 2 < low || z - kBand - 2 > high) continue;
      for_each_cell(one.on, one.normal, low, high, [&](const Cell& cell) {
        take(one.ball, centre_of(cell), 0.5 * edge(), ball_at(cell));
      });
    }
    step(end - begin);
  });
  touching_ = {};
}

// Cells that no ball reached take the best one of their neighbours.
void Builder::spread() {
  std::vector<Cell> left, next;
  for (Cell cell{0, 0, 0}; cell[2] < cells(2); ++cell[2]) {
    for (cell[1] = 0; cell[1] < cells(1); ++cell[1]) {
      for (cell[0] = 0; cell[0] < cells(0); ++cell[0]) {
        if (is_split_[group_of(cell)] != 0 && bound_[ball_at(cell)] == kNoBound)
          left.push_back(cell);
      }
    }
  }
  for (int turn = 0; turn < kSpreads && !left.empty(); ++turn) {
    next.clear();
    for (const Cell& cell : left) {
      const std::size_t at = ball_at(cell);
      for (std::size_t way = 0; way < 6; ++way) {
        Cell from = cell;
        from[way / 2] += way % 2 == 0 ? 1 : -1;
        if (!is_in_grid(from) || is_split_[group_of(from)] == 0) continue;
        const std::size_t ball = ball_at(from);
        if (bound_[ball] == kNoBound) continue;
        take(field_.balls[ball], centre_of(cell), 0.5 * edge(), at);
      }
      if (bound_[at] == kNoBound) next.push_back(cell);
    }
    std::reverse(next.begin(), next.end());
    left.swap(next);
  }
}

// Looks for a ball of a cell's own: the one round its centre, or beyond the nearest point.
OuterBall Builder::own_ball(const Vector& centre, double spread,
                            std::optional<std::uint32_t>& hint) const {
  const Vector at = whole(centre);
  const Place place = look(at, hint);
  const Vector on = in_units(place.nearest.on.point);
  const Vector way = place.is_outside ? difference(at, on) : difference(on, at);
  const double length = length_in_order(way);
  const Vector normal = length > 0 ? scaled(1 / length, way) : Vector(0, 0, 1);
  Tried best{far_ball(), bound_of(far_ball(), at, spread)};
  const auto offer = [&](const Vector& middle, double radius) {
    if (!(radius > 0)) return;
    const OuterBall ball = ball_of(middle, radius);
    const double bound = bound_of(ball, at, spread);
    if (bound < best.bound) best = {ball, bound};
  };
  if (!place.is_outside) {
    const Tried beyond = shrink(on, normal, at, spread, hint);
    return beyond.bound < best.bound ? beyond.ball : best.ball;
  }
  offer(at, place.radius);
  const Vector beyond = whole(sum(at, scaled(kLargestRadius * edge(), normal)));
  offer(beyond, look(beyond, hint).radius);
  return best.ball;
}

void Builder::fill() {
  struct Left {
    Vector centre;
    double spread;
    std::size_t at;
  };
  std::vector<Left> left;
  const auto group = static_cast<std::int32_t>(OuterBalls::kGroup);
  for (Cell cell{0, 0, 0}; cell[2] < cells(2); ++cell[2]) {
    for (cell[1] = 0; cell[1] < cells(1); ++cell[1]) {
      for (cell[0] = 0; cell[0] < cells(0); ++cell[0]) {
        const std::size_t at = ball_at(cell);
        if (is_split_[group_of(cell)] != 0) {
          if (bound_[at] == kNoBound) left.push_back({centre_of(cell), 0.5 * edge(), at});
        } else if (cell[0] % group == 0 && cell[1] % group == 0 && cell[2] % group == 0) {
          left.push_back({centre_of(cell, 0.5 * group), 0.5 * group * edge(), at});
        }
      }
    }
  }
  begin("filling outer balls", left.size());
  parallel_for(left.size(), kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::optional<std::uint32_t> hint;
    for (std::size_t i = begin; i < end; ++i) {
      field_.balls[left[i].at] = own_ball(left[i].centre, left[i].spread, hint);
    }
    step(end - begin);
  });
}

}  // namespace

OuterBalls make_outer_balls(const SphereTree& tree, std::uint64_t max_memory, Progress* progress) {
  static_cast<void>(
      parts_of(tree).triangles->sides());  // made here, so that its loops have all threads
  return Builder(tree, progress).build(max_memory);
}

}  // namespace ist
