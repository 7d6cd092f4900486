#include "ist/measure/point_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "ist/base/float_rounding.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// Points that one thread takes at a time. Neighbours in the list are often near each other.
constexpr std::size_t kGrain = 256;
// Points between two questions whether to go on: a few ms.
constexpr std::size_t kAtOnce = 1 << 14;

SurfaceDistance with_sign(const TreeTriangles& body, const NearestTriangle& nearest,
                          const Vector& point) {
  const Side side = body.side_of(point, nearest);
  const double distance = std::sqrt(nearest.square);
  return {side == Side::kInside ? -distance : distance, nearest.on.point, nearest.triangle,
          side != Side::kUnknown, !body.sides().self_intersections().pairs.empty()};
}

using Vector = Eigen::Vector3d;
// More than the error of a distance to a sliver, as a part of the coordinates.
constexpr double kTie = 0x1p-37;

// Finds points that are beyond a reach by outer balls alone: those in the ball of their cell by
// more than the reach.
class FarPoints {
 public:
  FarPoints(const OuterBalls& field, double reach, double size)
      : field_(field),
        to_units_(1 / field.unit),
        to_cells_(1 / double{field.cell}),
        reach_((reach + kTie * size) * to_units_) {
    for (std::size_t i = 0; i < 3; ++i) {
      low_[i] = field.low(i);
      last_[i] = static_cast<double>(OuterBalls::kGroup * field.groups[i]) - 0.5;
    }
  }

  [[nodiscard]] bool holds(const Vector& point) const noexcept {
    double at[3], size = 0;
    std::uint32_t cell[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      at[i] = (point[axis] - field_.middle[axis]) * to_units_;
      size = std::max(size, std::abs(at[i]));
      const double inside = (at[i] - low_[i]) * to_cells_;
      const double above = inside > 0 ? inside : 0;
      cell[i] = static_cast<std::uint32_t>(above < last_[i] ? above : last_[i]);
    }
    const OuterBall& ball = field_.balls[field_.ball_at(cell[0], cell[1], cell[2])];
    const double within = ball.radius() - (reach_ + kTie * size);
    if (!(within > 0)) return false;
    const double x = at[0] - ball.x(), y = at[1] - ball.y(), z = at[2] - ball.z();
    return (x * x + y * y) + z * z < within * within;
  }

 private:
  const OuterBalls& field_;
  const double to_units_, to_cells_, reach_;
  double low_[3], last_[3];
};

template <class Body>
void for_each_bit(std::uint32_t bits, const Body& body) {
  for (; bits != 0; bits &= bits - 1) body(static_cast<std::uint32_t>(std::countr_zero(bits)));
}

}  // namespace

bool is_any_inside(const SurfaceInBody& side) {
  const TreeTriangles& body = *parts_of(side.body).triangles;
  const auto& points = parts_of(side.surface).triangles->component_points();
  return std::any_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d at = side.to_body(point);
    if (body.sides().is_beyond(at)) return false;
    const auto nearest = side.search.nearest(at, HUGE_VAL);
    return nearest && body.side_of(at, *nearest) == Side::kInside;
  });
}

SurfaceDistance beyond_reach() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {kNone, {kNone, kNone, kNone}, SurfaceDistance::kNoTriangle, false, false};
}

std::vector<SurfaceDistance> distances_of(const SphereTree& tree, const PointSearch& search,
                                          std::span<const Vector> points, double reach,
                                          const Proceed& proceed) {
  std::vector<SurfaceDistance> out(points.size());
  const TreeTriangles& body = *parts_of(tree).triangles;
  static_cast<void>(body.sides());  // made here, so that its loops have all threads
  const double size = tree.bounding_radius() + tree.origin().cwiseAbs().maxCoeff();
  const std::optional<FarPoints> far =
      body.outer_balls() != nullptr && std::isfinite(reach)
          ? std::optional<FarPoints>(std::in_place, *body.outer_balls(), reach, size)
          : std::nullopt;
  for (std::size_t done = 0; done < points.size(); done += kAtOnce) {
    if (proceed && !proceed(static_cast<double>(done) / static_cast<double>(points.size()))) {
      out.resize(done);
      return out;
    }
    const std::size_t count = std::min(kAtOnce, points.size() - done);
    parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
      std::optional<std::uint32_t> last;
      for (std::size_t i = done + begin; i < done + end; ++i) {
        if (far && far->holds(points[i])) {
          out[i] = beyond_reach();
          continue;
        }
        const std::optional<NearestTriangle> nearest = search.nearest(points[i], reach, last);
        out[i] = nearest ? with_sign(body, *nearest, points[i]) : beyond_reach();
        if (nearest) last = nearest->triangle;
      }
    });
  }
  return out;
}

// One search.
class PointSearch::Descent {
 public:
  Descent(const PointSearch& search, const Vector& point, double within) noexcept
      : search_(search), point_(point) {
    const Eigen::Matrix3d& axes = search.clusters_.axes();
    const Vector from = difference(point, search.origin_);
    at_ = {dot_in_order(axes.col(0), from), dot_in_order(axes.col(1), from),
           dot_in_order(axes.col(2), from)};
    // The rounding of these coordinates, and of those of the clusters.
    error_ = 0x1p-44 * (search.size_ + from.cwiseAbs().maxCoeff());
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      tree_point_.at[axis] = static_cast<float>(at_[i]);
      tree_point_.rest[axis] = static_cast<float>(at_[i] - double{tree_point_.at[axis]});
    }
    tree_point_.error = rounded_up(4 * error_);
    tie_ = kTie * (search.size_ + from.cwiseAbs().maxCoeff());
    most_ = within * within;
    set_far(most_);
  }

  void measure(std::uint32_t triangle) noexcept {
    const Triangle& t = search_.mesh_.triangles[triangle];
    const auto& vertices = search_.mesh_.vertices;
    const NearestPoint on =
        nearest_on_triangle({vertices[t[0]], vertices[t[1]], vertices[t[2]]}, point_);
    const Vector way = difference(point_, on.point);
    NearestTriangle next{dot_in_order(way, way), triangle, on};
    if (!(next.square <= tied_) || (best_ && best_->triangle == triangle)) return;
    const bool is_other = best_ && !has_feature_of(*best_, next);
    if (best_ ? std::pair(best_->square, best_->triangle) < std::pair(next.square, triangle)
              : !(next.square <= most_)) {
      if (best_) best_->is_tied = best_->is_tied || is_other;
      return;
    }
    set_far(next.square);
    next.is_tied = best_ && best_->square <= tied_ && (best_->is_tied || is_other);
    best_ = next;
  }

  void run() noexcept {
    const TriangleClusters& clusters = search_.clusters_;
    std::array<Node, TriangleClusters::kMostLevels * kClusterWidth> stack;
    std::size_t size = 0;
    stack[size++] = {0, 0, clusters.root_level()};
    while (size > 0) {
      const Node node = stack[--size];
      if (node.square > far_) continue;
      if (node.level == 0) {
        compare(node.index);
        continue;
      }
      alignas(64) float squares[kClusterWidth];
      const int level = node.level - 1;
      const std::uint32_t near = search_.kernels_.near_nodes(clusters.bounds(level)[node.index],
                                                             tree_point_, far_, squares);
      const std::size_t base = size;
      for_each_bit(near & lanes_of(clusters.child_count(level, node.index)),
                   [&](std::uint32_t child) {
                     std::size_t at = size++;  // the nearest on top
                     for (; at > base && stack[at - 1].square < squares[child]; --at)
                       stack[at] = stack[at - 1];
                     stack[at] = {squares[child], kClusterWidth * node.index + child, level};
                   });
    }
    measure_candidates();
  }

  [[nodiscard]] const std::optional<NearestTriangle>& best() const noexcept { return best_; }

 private:
  struct Node {
    float square;
    std::uint32_t index;
    int level;
  };

  struct Candidate {
    float square;  // its distance's, at least
    std::uint32_t triangle;
  };

  // From now on triangles count whose distance is no greater, or greater by rounding alone.
  void set_far(double square) noexcept {
    const double distance = std::sqrt(square) + tie_;
    tied_ = distance * distance;
    far_ = std::min(far_, rounded_up(tied_));
  }

  // Returns whether the nearest points of two triangles lie on one corner or edge of both.
  [[nodiscard]] bool has_feature_of(const NearestTriangle& a, const NearestTriangle& b) const {
    if ((a.on.feature < 3) != (b.on.feature < 3)) return false;
    if (a.on.feature == NearestPoint::kInside || b.on.feature == NearestPoint::kInside)
      return false;
    const auto corner = [this](const NearestTriangle& of, int next) -> const Vector& {
      return search_.mesh_.vertices[search_.mesh_.triangles[of.triangle][static_cast<std::size_t>(
          (of.on.feature + next) % 3)]];
    };
    if (a.on.feature < 3) return corner(a, 0) == corner(b, 0);
    return (corner(a, 0) == corner(b, 0) && corner(a, 1) == corner(b, 1)) ||
           (corner(a, 0) == corner(b, 1) && corner(a, 1) == corner(b, 0));
  }

  static std::uint32_t lanes_of(std::uint32_t count) noexcept {
    return (std::uint32_t{1} << count) - 1;
  }

  // Takes down the triangles of a cluster that may be nearest.
  void compare(std::uint32_t index) noexcept {
    const TriangleClusters& clusters = search_.clusters_;
    const TriangleCluster& cluster = clusters.clusters()[index];
    const NodeBlock& block = clusters.bounds(0)[index / kClusterWidth];
    const std::size_t lane = index % kClusterWidth;
    Vector from;
    for (Eigen::Index i = 0; i < 3; ++i) {
      from[i] = at_[i] - double{block.centre[static_cast<std::size_t>(i)][lane]};
    }
    ClusterPoint point;
    double size = block.radius[lane];
    for (std::size_t i = 0; i < 3; ++i) {
      const double along = (cluster.axis[0][i] * from[0] + cluster.axis[1][i] * from[1]) +
                           cluster.axis[2][i] * from[2];
      point.at[i] = static_cast<float>(along);
      size += std::abs(along);
    }
    point.error = rounded_up(4 * error_ + double{kPointRounding} * size);
    point.unit = unit_for(block.radius[lane]);
    alignas(64) float squares[kClusterWidth];
    const std::uint32_t near = search_.kernels_.near_triangles(cluster, point, far_, squares);
    if (candidate_count_ > candidates_.size() - kClusterWidth) measure_candidates();
    for_each_bit(near & lanes_of(clusters.child_count(-1, index)), [&](std::uint32_t k) {
      candidates_[candidate_count_++] = {squares[k], cluster.id[k]};
    });
  }

  void measure_candidates() noexcept {
    for (std::size_t k = 0; k < candidate_count_; ++k) {
      if (!(candidates_[k].square > far_)) measure(candidates_[k].triangle);
    }
    candidate_count_ = 0;
  }

  const PointSearch& search_;
  const Vector& point_;
  Vector at_;     // in the tree's frame
  double error_;  // of a coordinate there
  TreePoint tree_point_{};
  double tie_;   // distances that differ by less may differ by rounding alone
  double most_;  // the square of the reach
  double tied_ = 0;
  float far_ = std::numeric_limits<float>::infinity();
  std::array<Candidate, 4 * kClusterWidth> candidates_;  // not yet measured
  std::size_t candidate_count_ = 0;
  std::optional<NearestTriangle> best_;
};

PointSearch::PointSearch(const SphereTree& tree, const ClusterKernels& kernels) noexcept
    : mesh_(*tree.triangles()),
      clusters_(parts_of(tree).triangles->clusters),
      kernels_(kernels),
      origin_(tree.origin()),
      size_(tree.bounding_radius() + tree.origin().cwiseAbs().maxCoeff()) {}

std::optional<NearestTriangle> PointSearch::nearest(
    const Vector& point, double within, std::optional<std::uint32_t> hint) const noexcept {
  Descent descent(*this, point, within);
  if (hint) descent.measure(*hint);
  descent.run();
  // Clusters of a file that no library wrote may hide all triangles.
  if (!descent.best() && within == HUGE_VAL) descent.measure(0);
  return descent.best();
}

}  // namespace ist
