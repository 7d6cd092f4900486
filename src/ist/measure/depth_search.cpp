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

DepthSearch::DepthSearch(std::vector<SurfaceInBody> sides, double rounding, const Budget& budget,
                         const Proceed& proceed)
    : sides_(std::move(sides)), rounding_(rounding), budget_(budget), proceed_(proceed) {}

void DepthSearch::begin_at(std::size_t side, std::uint32_t triangle, const Vector& near) {
  const auto of = static_cast<std::uint32_t>(side);
  const Vector at = nearest_on_triangle(corners(of, triangle), near).point;
  offer(of, triangle, at, measure(of, at, {}));
}

bool DepthSearch::run(double tolerance) {
  tolerance_ = std::max(tolerance, 4 * rounding_);
  for (std::uint32_t side = 0; side < sides_.size(); ++side) {
    const TriangleClusters& clusters = parts_of(sides_[side].surface).triangles->clusters;
    add_node(side, clusters.root_level(), 0, nullptr);
  }
  const double first_bound = bound();
  while (!heap_.empty() && heap_.front().bound > least() + tolerance_) {
    if (!goes_on(first_bound)) return false;
    std::pop_heap(heap_.begin(), heap_.end());
    const Item item = heap_.back();
    heap_.pop_back();
    open(item);
  }
  return true;
}

bool DepthSearch::goes_on(double first_bound) {
  capped_ = pieces_.size() > kMostPieces;
  if (points_ >= budget_.tests || capped_) return false;
  if (points_ - looked_ >= kLook) {
    looked_ = points_;
    if (budget_.is_past()) return false;
  }
  if (!proceed_ || points_ - asked_ < kAsk) return true;
  asked_ = points_;
  const double left = (bound() - least()) / std::max(first_bound, tolerance_);
  return proceed_(std::clamp(1 - left, 0.0, 1.0));
}

double DepthSearch::bound() const noexcept {
  const double left = heap_.empty() ? 0 : heap_.front().bound;
  return std::max({least(), left, dropped_});
}

// Puts the children of a node, or the parts of a piece, in its place. Quarters of a long and thin
// piece would be as long and thin: such a piece is cut in two.
void DepthSearch::open(const Item& item) {
  if (item.level == kPiece) {
    const Piece piece = pieces_[item.index];
    const Corners& t = piece.corner;
    if (const std::optional<std::size_t> edge = edge_to_cut(t)) {
      const Vector &a = t[*edge], &b = t[(*edge + 1) % 3], &c = t[(*edge + 2) % 3];
      const Vector cut = middle(a, b);
      add_piece(item.side, {{a, cut, c}, piece.triangle}, item.middle);
      add_piece(item.side, {{cut, b, c}, piece.triangle}, item.middle);
      return;
    }
    const Corners between = {middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])};
    add_piece(item.side, {between, piece.triangle}, item.middle);
    for (std::size_t i = 0; i < 3; ++i) {
      add_piece(item.side, {{t[i], between[i], between[(i + 2) % 3]}, piece.triangle}, item.middle);
    }
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
    deepest_ = {side, triangle, at, measured.nearest.on.point, depth};
}

// Returns whether what has this bound is not worth a look.
bool DepthSearch::drops(double bound) noexcept {
  if (bound > least() + tolerance_) return false;
  dropped_ = std::max(dropped_, bound);
  return true;
}

double DepthSearch::distance_to(std::uint32_t side, std::uint32_t triangle, const Vector& p) const {
  const TriangleMesh& mesh = *sides_[side].body.triangles();
  const Triangle& t = mesh.triangles[triangle];
  const auto& v = mesh.vertices;
  return distance_between(p, nearest_on_triangle({v[t[0]], v[t[1]], v[t[2]]}, p).point);
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
  // The distance from one triangle is a convex function: no point is farther than some corner.
  double farthest = 0;
  std::size_t corner = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double far = distance_to(side, measured.nearest.triangle, t[i]);
    if (far > farthest) corner = i;
    farthest = std::max(far, farthest);
  }
  const double bound = std::min(std::min(measured.depth + radius, farthest) + rounding_, in_box);
  if (drops(bound)) return;
  offer(side, piece.triangle, t[corner], measure(side, t[corner], measured.nearest.triangle));
  pieces_.push_back(piece);
  push({bound,
        {at, measured.depth, measured.nearest.triangle},
        side,
        static_cast<std::uint32_t>(pieces_.size() - 1),
        kPiece});
}

}  // namespace ist
