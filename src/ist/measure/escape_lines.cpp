#include "ist/measure/escape_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ist/base/direction.h"
#include "ist/base/ordered_vector.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// So many pairs of triangles that meet are looked at.
constexpr std::size_t kMeetingPairs = 1 << 12;
// Normals within this cosine of a cluster belong to it.
constexpr double kOneCluster = 0.95;
constexpr std::size_t kClusters = 24, kUsedClusters = 12;
// Directions nearer than this, a cosine, are one.
constexpr double kOneDirection = 0.9999;
// The first step of a line, as a part of the tolerance, and the factor from one to the next.
constexpr double kFirstStep = 1, kStepGrowth = 1.6;
// A way is known to this part of the tolerance.
constexpr double kWayKnown = 0.25;

// Directions that are near each other, and their sum.
class NormalClusters {
 public:
  void add(const Vector& direction, double weight) {
    for (Cluster& cluster : clusters_) {
      if (dot_in_order(cluster.first, direction) < kOneCluster) continue;
      add_to(cluster.sum, scaled(weight, direction));
      cluster.weight += weight;
      return;
    }
    if (clusters_.size() < kClusters) {
      clusters_.push_back({direction, scaled(weight, direction), weight});
    }
  }
  // The heaviest first.
  [[nodiscard]] std::vector<Vector> means() {
    std::stable_sort(clusters_.begin(), clusters_.end(),
                     [](const Cluster& a, const Cluster& b) { return a.weight > b.weight; });
    std::vector<Vector> means;
    for (const Cluster& cluster : clusters_) means.push_back(cluster.sum);
    return means;
  }

 private:
  struct Cluster {
    Vector first, sum;
    double weight;
  };
  std::vector<Cluster> clusters_;
};

// The normals of a body's triangles, as ways of the moving body.
class WaysOut {
 public:
  // @param sign 1 if the moving body goes along the normals
  WaysOut(const SphereTree& tree, const RigidMove& to_fixed, double sign)
      : mesh_(parts_of(tree).triangles->mesh),
        to_fixed_(to_fixed),
        sign_(sign),
        is_closed_(tree.orientation() == Orientation::kOutward) {}

  [[nodiscard]] std::size_t size() const { return mesh_.triangles.size(); }
  // Twice the area long.
  [[nodiscard]] Vector operator()(std::size_t triangle) const {
    const Triangle& t = mesh_.triangles[triangle];
    const Vector &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
    return scaled(sign_, to_fixed_.turned(cross_in_order(difference(b, a), difference(c, a))));
  }
  // An open body has no outside: the moving body may go either way.
  void add(const Vector& normal, double weight, NormalClusters& clusters) const {
    const std::optional<Direction> way = direction_of(normal);
    if (!way) return;
    clusters.add(way->unit, weight);
    if (!is_closed_) clusters.add(scaled(-1, way->unit), weight);
  }

 private:
  const TriangleMesh& mesh_;
  const RigidMove& to_fixed_;
  double sign_;
  bool is_closed_;
};

double rounding_of(const Query& query, const Eigen::Isometry3d& pose, double way) {
  const auto size = [](const SphereTree& tree) {
    return tree.bounding_radius() + tree.origin().cwiseAbs().maxCoeff();
  };
  return 0x1p-40 * (size(query.fixed()) + size(query.moving()) +
                    pose.translation().cwiseAbs().maxCoeff() + way);
}

}  // namespace

std::vector<Vector> escape_directions(Query& query, const Eigen::Isometry3d& pose,
                                      const Vector& deepest) {
  std::vector<Vector> directions;
  const auto add = [&](const Vector& along) {
    const std::optional<Direction> way = direction_of(along);
    if (!way) return;
    for (const Vector& known : directions) {
      if (dot_in_order(known, way->unit) > kOneDirection) return;
    }
    directions.push_back(way->unit);
  };
  add(deepest);

  const RigidMove move(pose), stay(Eigen::Isometry3d::Identity());
  const WaysOut fixed(query.fixed(), stay, 1), moving(query.moving(), move, -1);
  std::vector<TrianglePair> pairs(kMeetingPairs);
  const TrianglePairsResult meeting = query.triangle_pairs(pose, pairs);
  pairs.resize(
      static_cast<std::size_t>(std::min<std::uint64_t>(meeting.triangle_pairs, pairs.size())));
  NormalClusters clusters;
  Vector all(0, 0, 0);
  for (const TrianglePair& pair : pairs) {
    const Vector of_fixed = fixed(pair.fixed), of_moving = moving(pair.moving);
    const double area = std::min(length_in_order(of_fixed), length_in_order(of_moving));
    fixed.add(of_fixed, area, clusters);
    moving.add(of_moving, area, clusters);
    const auto sum_up = [&](const Vector& normal) {
      if (const auto way = direction_of(normal)) add_to(all, scaled(area, way->unit));
    };
    sum_up(of_fixed);
    sum_up(of_moving);
  }
  add(all);
  if (pairs.empty()) {  // one body inside the other: any face may be the nearest
    for (const WaysOut* side : {&fixed, &moving}) {
      for (std::size_t i = 0; i < side->size(); ++i) {
        const Vector normal = (*side)(i);
        side->add(normal, length_in_order(normal), clusters);
      }
    }
  }
  const std::vector<Vector> means = clusters.means();
  for (std::size_t i = 0; i < std::min(means.size(), kUsedClusters); ++i) add(means[i]);
  add(difference(move(query.moving().origin()), query.fixed().origin()));
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) add(Vector(x, y, z));
    }
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Vector axis = move.turned(Vector::Unit(i));
    add(axis);
    add(scaled(-1, axis));
  }
  return directions;
}

EscapeLines::EscapeLines(FreeTest& free, const Query& query, const Eigen::Isometry3d& pose,
                         double least, double tolerance)
    : free_(free), pose_(pose), least_(least), tolerance_(tolerance) {
  const Vector middle = RigidMove(pose)(query.moving().origin());
  const double far = length_in_order(difference(middle, query.fixed().origin())) +
                     query.fixed().bounding_radius() + query.moving().bounding_radius();
  apart_ = far + rounding_of(query, pose, far);
}

std::optional<double> EscapeLines::way(const Vector& direction, double most) {
  const auto is_free_after = [&](double way) {
    Eigen::Isometry3d pose = pose_;
    pose.translation() = sum(pose_.translation(), scaled(way, direction));
    return free_.at(pose);
  };
  const double last = std::min(most, apart_);
  double bad = least_, good = 0;
  for (double step = kFirstStep * tolerance_; good < last; step *= kStepGrowth) {
    good = std::min(least_ + step, last);
    if (is_free_after(good)) break;
    if (good >= last || free_.is_ended()) return std::nullopt;
    bad = good;
  }
  while (good - bad > kWayKnown * tolerance_ && !free_.is_ended()) {
    const double middle = 0.5 * (good + bad);
    (is_free_after(middle) ? good : bad) = middle;
  }
  return good > 0 ? std::optional(good) : std::nullopt;
}

}  // namespace ist
