#include "ist/measure/depth_search.h"

#include <algorithm>
#include <cmath>

#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;
// Points between two looks at the clock.
constexpr std::uint64_t kLook = 32;
// Points between two questions whether to go on.
constexpr std::uint64_t kAsk = 1024;
// A piece of a triangle that was handed over is measured if its triangle has fewer near triangles,
// or was quartered as often. Quartering is cheaper than measuring if some near triangles are known.
constexpr std::uint8_t kFewNear = 2;
constexpr int kMeasuredFrom = 3;
// The least height of a piece that is quartered, as a part of its longest edge.
constexpr double kLeastHeight = 1.0 / 4;

double distance_between(const Vector& a, const Vector& b) {
  const Vector way = difference(a, b);
  return std::sqrt(dot_in_order(way, way));
}

Vector middle(const Vector& a, const Vector& b) { return scaled(0.5, sum(a, b)); }

Vector middle(const std::array<Vector, 3>& t) {
  return scaled(1.0 / 3, sum(sum(t[0], t[1]), t[2]));
}

// The longest edge of a long and thin piece: from this corner to the next one. Nothing for other
// pieces.
std::optional<std::size_t> edge_to_cut(const std::array<Vector, 3>& t) {
  double longest = 0;  // a square
  std::size_t edge = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double square = square_in_order(difference(t[(i + 1) % 3], t[i]));
    if (square > longest) edge = i;
    longest = std::max(longest, square);
  }
  const Vector area = cross_in_order(difference(t[1], t[0]), difference(t[2], t[0]));
  const double most = (kLeastHeight * longest) * (kLeastHeight * longest);
  return square_in_order(area) < most ? std::optional(edge) : std::nullopt;
}

}  // namespace

DepthSearch::DepthSearch(std::vector<SurfaceInBody> sides)
    : sides_(std::move(sides)), balls_(sides_.size()) {}

void DepthSearch::begin(const DepthQuestion& question) noexcept {
  question_ = &question;
  rounding_ = question.rounding;
  tolerance_ = std::max(question.tolerance, 4 * rounding_);
  dropped_ = first_bound_ = 0;
  heap_.clear();
  pieces_.clear();
  handed_.clear();
  for (Looked& one : looks_) one.handed = kNotHanded;
  deepest_.reset();
  points_ = looked_ = asked_ = 0;
  capped_ = ended_ = false;
}

void DepthSearch::begin_at(std::size_t side, std::uint32_t triangle, const Vector& near) {
  const auto of = static_cast<std::uint32_t>(side);
  const Vector at = nearest_on_triangle(corners(of, triangle), near).point;
  offer(of, triangle, at, measure(of, at, {}));
}

void DepthSearch::begin_at(const Point& last) {
  const auto of = static_cast<std::uint32_t>(last.side);
  const Corners t = corners(of, last.triangle);
  const Vector at = nearest_on_triangle(t, last.at).point;
  const Measured measured = measure(of, at, last.near_triangle);
  offer(of, last.triangle, at, measured);
  const Vector& corner = t[farthest(of, measured.nearest.triangle, t).corner];
  offer(of, last.triangle, corner, measure(of, corner, measured.nearest.triangle));
}

void DepthSearch::probe(std::uint32_t side, std::uint32_t triangle) {
  const Corners t = corners(side, triangle);
  const Vector at = middle(t);
  const Measured measured = measure(side, at, {});
  offer(side, triangle, at, measured);
  const Farthest far = farthest(side, measured.nearest.triangle, t);
  if (is_settled(far.distance)) return;
  const Vector& corner = t[far.corner];
  offer(side, triangle, corner, measure(side, corner, measured.nearest.triangle));
}

void DepthSearch::add_surfaces() {
  for (std::uint32_t side = 0; side < sides_.size(); ++side) {
    const TriangleClusters& clusters = parts_of(sides_[side].surface).triangles->clusters;
    add_node(side, clusters.root_level(), 0, nullptr);
  }
}

std::size_t DepthSearch::add_triangle(std::uint32_t side, std::uint32_t triangle, double bound,
                                      const FewTriangles& near, bool has_served) {
  const std::size_t at = handed_.size();
  handed_.push_back({0, near});
  add_handed(side, {corners(side, triangle), triangle, static_cast<std::uint32_t>(at), 0}, bound,
             !has_served);
  return at;
}

bool DepthSearch::run() {
  first_bound_ = bound();
  while (!heap_.empty() && !is_settled(heap_.front().bound)) {
    if (!goes_on()) break;
    std::pop_heap(heap_.begin(), heap_.end());
    const Item item = heap_.back();
    heap_.pop_back();
    open(item);
  }
  for (const Item& item : heap_) {
    if (item.level != kPiece || pieces_[item.index].handed == kNotHanded) continue;
    double& whole = handed_[pieces_[item.index].handed].bound;
    whole = std::max(whole, item.bound);
  }
  return !ended_;
}

bool DepthSearch::goes_on() {
  if (ended_) return false;
  capped_ = pieces_.size() > kMostPieces;
  ended_ = points_ >= question_->budget.tests || capped_;
  if (!ended_ && points_ - looked_ >= kLook) {
    looked_ = points_;
    ended_ = question_->budget.is_past();
  }
  if (ended_ || !question_->proceed || points_ - asked_ < kAsk) return !ended_;
  asked_ = points_;
  const double left = (bound() - least()) / std::max(first_bound_, tolerance_);
  ended_ = !question_->proceed(std::clamp(1 - left, 0.0, 1.0));
  return !ended_;
}

double DepthSearch::bound() const noexcept {
  const double left = heap_.empty() ? 0 : heap_.front().bound;
  return std::max({least(), left, dropped_});
}

// Puts the children of a node, or the parts of a piece, in its place.
void DepthSearch::open(const Item& item) {
  if (item.level == kPiece) {
    open_piece(item);
    return;
  }
  const TriangleClusters& clusters = parts_of(sides_[item.side].surface).triangles->clusters;
  const std::uint32_t count = clusters.child_count(item.level - 1, item.index);
  for (std::uint32_t k = 0; k < count; ++k) {
    if (item.level > 0) {
      add_node(item.side, item.level - 1, kClusterWidth * item.index + k, &item.middle);
    } else {
      const std::uint32_t triangle = clusters.clusters()[item.index].id[k];
      add_piece(item.side, {corners(item.side, triangle), triangle}, item.middle);
    }
  }
}

// Quarters of a long and thin piece would be as long and thin: such a piece is cut in two.
void DepthSearch::open_piece(const Item& item) {
  const Piece piece = pieces_[item.index];
  const Corners& t = piece.corner;
  const auto add = [&](const Corners& part) {
    const Piece next{part, piece.triangle, piece.handed, piece.depth + 1};
    if (piece.handed == kNotHanded) {
      add_piece(item.side, next, item.middle);
    } else {
      add_handed(item.side, next, item.bound, false);
    }
  };
  if (const std::optional<std::size_t> edge = edge_to_cut(t)) {
    const Vector &a = t[*edge], &b = t[(*edge + 1) % 3], &c = t[(*edge + 2) % 3];
    const Vector cut = middle(a, b);
    add({a, cut, c});
    add({cut, b, c});
    return;
  }
  const Corners between = {middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])};
  add(between);
  for (std::size_t i = 0; i < 3; ++i) add({t[i], between[i], between[(i + 2) % 3]});
}

DepthSearch::Corners DepthSearch::corners(std::uint32_t side, std::uint32_t triangle) const {
  const TriangleMesh& mesh = *sides_[side].surface.triangles();
  const Triangle& t = mesh.triangles[triangle];
  const RigidMove& move = sides_[side].to_body;
  return {move(mesh.vertices[t[0]]), move(mesh.vertices[t[1]]), move(mesh.vertices[t[2]])};
}

DepthSearch::Measured DepthSearch::measure(std::uint32_t side, const Vector& at,
                                           std::optional<std::uint32_t> hint) {
  ++points_;
  const SurfaceInBody& of = sides_[side];
  const NearestTriangle nearest = *of.search.nearest(at, HUGE_VAL, hint);
  const Side side_there = parts_of(of.body).triangles->side_of(at, nearest);
  const double distance = std::sqrt(nearest.square);
  return {side_there == Side::kOutside ? -distance : distance, side_there != Side::kUnknown,
          nearest};
}

void DepthSearch::offer(std::uint32_t side, std::uint32_t triangle, const Vector& at,
                        const Measured& measured) {
  const double depth = measured.depth - rounding_;
  if (measured.is_known && depth > least())
    deepest_ = {side, triangle, at, measured.nearest.on.point, measured.nearest.triangle, depth};
}

// Returns whether what has this bound is not worth a look.
bool DepthSearch::drops(double bound) noexcept {
  if (!is_settled(bound)) return false;
  dropped_ = std::max(dropped_, bound);
  return true;
}

bool DepthSearch::drops(double bound, Handed& of) noexcept {
  if (!drops(bound)) return false;
  of.bound = std::max(of.bound, bound);
  return true;
}

double DepthSearch::distance_to(std::uint32_t side, std::uint32_t triangle, const Vector& p) const {
  const TriangleMesh& mesh = *sides_[side].body.triangles();
  const Triangle& t = mesh.triangles[triangle];
  const auto& v = mesh.vertices;
  return distance_between(p, nearest_on_triangle({v[t[0]], v[t[1]], v[t[2]]}, p).point);
}

// Returns the distance of a triangle's farthest corner from one triangle of the body. The distance
// is a convex function: no point of the triangle is farther.
DepthSearch::Farthest DepthSearch::farthest(std::uint32_t side, std::uint32_t triangle,
                                            const Corners& corners) const {
  Farthest found{0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const double far = distance_to(side, triangle, corners[i]);
    if (far > found.distance) found.corner = i;
    found.distance = std::max(far, found.distance);
  }
  return found;
}

// Returns how deep a point lies in the box round the body; negative outside the box. It lies no
// deeper in the body.
double DepthSearch::depth_in_box(std::uint32_t side, const Vector& at) const {
  const Eigen::AlignedBox3d& box = parts_of(sides_[side].body).triangles->box();
  const Vector above = difference(at, box.min()), below = difference(box.max(), at);
  return std::min({above[0], above[1], above[2], below[0], below[1], below[2]});
}

// Returns the most of any point of a piece: below each face of the box, a corner is the deepest.
double DepthSearch::depth_in_box(std::uint32_t side, const Corners& corners) const {
  const Eigen::AlignedBox3d& box = parts_of(sides_[side].body).triangles->box();
  double least = HUGE_VAL;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double a = corners[0][i], b = corners[1][i], c = corners[2][i];
    least =
        std::min({least, std::max({a, b, c}) - box.min()[i], box.max()[i] - std::min({a, b, c})});
  }
  return least;
}

void DepthSearch::push(const Item& item) {
  if (drops(item.bound)) return;
  heap_.push_back(item);
  std::push_heap(heap_.begin(), heap_.end());
}

// Returns whether a ball need not be looked at, by what is known of the middle of what holds it: a
// depth changes by no more than the way, and is no more than the distance from any triangle.
bool DepthSearch::drops_below(const Middle& parent, std::uint32_t side, const Vector& at,
                              double radius) {
  return drops(parent.depth + distance_between(at, parent.at) + radius) ||
         drops(distance_to(side, parent.triangle, at) + radius);
}

void DepthSearch::add_node(std::uint32_t side, int level, std::uint32_t index,
                           const Middle* parent) {
  const SphereTree& surface = sides_[side].surface;
  const TriangleClusters& clusters = parts_of(surface).triangles->clusters;
  const NodeBlock& block = clusters.bounds(level)[index / kClusterWidth];
  const std::size_t lane = index % kClusterWidth;
  Vector centre = surface.origin();
  for (Eigen::Index i = 0; i < 3; ++i) {
    add_to(centre, scaled(block.centre[static_cast<std::size_t>(i)][lane], clusters.axes().col(i)));
  }
  const Vector at = sides_[side].to_body(centre);
  const double radius = double{block.radius[lane]} + rounding_;
  const double in_box = depth_in_box(side, at) + radius;
  if (drops(in_box)) return;
  if (parent != nullptr && drops_below(*parent, side, at, radius)) return;
  const Measured measured =
      parent != nullptr ? measure(side, at, parent->triangle) : measure(side, at, {});
  // A point of the surface, so that the search soon knows what is not worth a look.
  if (level == 0 && measured.depth > least()) {
    const std::uint32_t triangle = clusters.clusters()[index].id[0];
    const Vector there = middle(corners(side, triangle));
    offer(side, triangle, there, measure(side, there, measured.nearest.triangle));
  }
  push({std::min(measured.depth + radius, in_box),
        {at, measured.depth, measured.nearest.triangle},
        side,
        index,
        level});
}

void DepthSearch::add_piece(std::uint32_t side, const Piece& piece, const Middle& parent) {
  const Corners& t = piece.corner;
  const double in_box = depth_in_box(side, t) + rounding_;
  if (drops(in_box)) return;
  const Vector at = middle(t);
  double radius = 0;
  for (const Vector& corner : t) radius = std::max(radius, distance_between(corner, at));
  if (drops_below(parent, side, at, radius + rounding_)) return;
  const Measured measured = measure(side, at, parent.triangle);
  offer(side, piece.triangle, at, measured);
  const Farthest far = farthest(side, measured.nearest.triangle, t);
  const double bound =
      std::min(std::min(measured.depth + radius, far.distance) + rounding_, in_box);
  if (drops(bound)) return;
  const Vector& corner = t[far.corner];
  offer(side, piece.triangle, corner, measure(side, corner, measured.nearest.triangle));
  pieces_.push_back(piece);
  push({bound,
        {at, measured.depth, measured.nearest.triangle},
        side,
        static_cast<std::uint32_t>(pieces_.size() - 1),
        kPiece});
}

// The least bound of a triangle by the balls near its middle.
double DepthSearch::depth_by_balls(std::uint32_t side, const Corners& corners) const {
  const Balls& balls = balls_[side];
  BallTriangle t;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector at = scaled(1 / balls.unit, difference(corners[k], balls.middle));
    for (std::size_t i = 0; i < 3; ++i) {
      t[k][i] = static_cast<float>(at[static_cast<Eigen::Index>(i)]);
    }
  }
  const double bound = double{balls.bound_around(t, balls.grid, balls.pad)} * balls.unit;
  return bound < HUGE_VAL ? bound : HUGE_VAL;
}

// Returns whether a corner of a piece is none of those that were measured last, and remembers it.
bool DepthSearch::is_new(std::uint32_t handed, const Vector& corner) noexcept {
  for (const Looked& one : looks_) {
    if (one.handed == handed && one.at == corner) return false;
  }
  looks_[look_count_++ % looks_.size()] = {handed, corner};
  return true;
}

// Adds a piece of a triangle that was handed over, if neither the triangles that were nearest to
// other pieces nor the balls round it nor points show that it is settled.
void DepthSearch::add_handed(std::uint32_t side, const Piece& piece, double bound,
                             bool balls_first) {
  Handed& handed = handed_[piece.handed];
  const Corners& t = piece.corner;
  const auto settles = [&](double other) {
    bound = std::min(bound, other);
    return drops(bound, handed);
  };
  if (drops(bound, handed) || settles(depth_in_box(side, t) + rounding_)) return;
  const auto by_near = [&](std::size_t k) {
    return farthest(side, handed.near.triangle[k], t).distance + rounding_;
  };
  if (!balls_first && handed.near.count > 0 && settles(by_near(0))) return;
  if (settles(depth_by_balls(side, t))) return;
  for (std::size_t k = balls_first ? 0 : 1; k < handed.near.count; ++k) {
    if (!settles(by_near(k))) continue;
    std::swap(handed.near.triangle[0], handed.near.triangle[k]);
    return;
  }
  const Vector at = middle(t);
  if (handed.near.count < kFewNear || piece.depth >= kMeasuredFrom) {
    double radius = 0;
    for (const Vector& corner : t) radius = std::max(radius, distance_between(corner, at));
    const auto hint = handed.near.count > 0 ? std::optional(handed.near.triangle[0]) : std::nullopt;
    const Measured measured = measure(side, at, hint);
    handed.near.add(measured.nearest.triangle);
    offer(side, piece.triangle, at, measured);
    const Farthest far = farthest(side, measured.nearest.triangle, t);
    if (settles(std::min(measured.depth + radius, far.distance) + rounding_)) return;
    const Vector& corner = t[far.corner];
    if (is_new(piece.handed, corner)) {
      const Measured there = measure(side, corner, measured.nearest.triangle);
      offer(side, piece.triangle, corner, there);
      handed.near.add(there.nearest.triangle);
      if (settles(farthest(side, there.nearest.triangle, t).distance + rounding_)) return;
    }
  }
  if (drops(bound, handed)) return;
  pieces_.push_back(piece);
  push({bound,
        {at, bound, kNotHanded},
        side,
        static_cast<std::uint32_t>(pieces_.size() - 1),
        kPiece});
}

}  // namespace ist
