#include "ist/measure/escape_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ist/base/ordered_vector.h"
#include "ist/base/rigid_move.h"
#include "ist/measure/escape_lines.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

constexpr int kEscapeSteps = 60, kEscapeRounds = 3, kPartHalvings = 40;
// Parts of the tolerance: the gap that stays open, and a gain that is too small for a step.
constexpr double kOpenGap = 0.125, kWorthAStep = 0.125;
// The first trust is this part of the motion's length. A trust below this part of the skin ends.
constexpr double kTrustBegins = 0.1, kTrustEnds = 0.25;
// A step is kept if it gains this part of its promise.
constexpr double kStepKept = 0.1, kStepGood = 0.7, kStepLong = 0.5;
constexpr double kFeatureSlope = 0.2;  // of normals of features, a sine
// Near pairs are listed to so many times the trust.
constexpr double kReachOfTrust = 1.1;
constexpr std::size_t kFirstRoom = 1 << 12, kMostRoom = 1 << 16, kFeatureRoom = 4096;
// Rounds of weights in a step, and the least weight.
constexpr int kWeightings = 8;
constexpr double kLeastWeight = 1e-4;

double size_of_step(const Vector6& a) noexcept {
  double sum = 0;
  for (Eigen::Index i = 0; i < 6; ++i) sum += a[i] * a[i];
  return std::sqrt(sum);
}

const TriangleMesh& triangles_in(const SphereTree& tree) { return parts_of(tree).triangles->mesh; }

// The vertices in use that are farthest along 26 directions.
std::vector<Vector> outermost_of(const TriangleMesh& mesh) {
  std::vector<Vector> directions, points;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x != 0 || y != 0 || z != 0) directions.emplace_back(x, y, z);
      }
    }
  }
  std::vector<double> most(directions.size(), -std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> which(directions.size());
  std::vector<bool> used(mesh.vertices.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) used[v] = true;
  }
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const double height = dot_in_order(directions[i], mesh.vertices[v]);
      if (!(height > most[i])) continue;
      most[i] = height;
      which[i] = v;
    }
  }
  std::sort(which.begin(), which.end());
  which.erase(std::unique(which.begin(), which.end()), which.end());
  for (const std::uint32_t v : which) points.push_back(mesh.vertices[v]);
  return points;
}

}  // namespace

EscapeSteps::EscapeSteps(Query& query, FreeTest& free, const Eigen::Isometry3d& pose,
                         double tolerance)
    : query_(query),
      free_(free),
      frame_(pose, query.moving().origin()),
      middle_(RigidMove(pose)(query.moving().origin())),
      radius_(query.moving().bounding_radius()),
      tolerance_(tolerance),
      skin_(kOpenGap * tolerance),
      outermost_(outermost_of(triangles_in(query.moving()))),
      ways_(outermost_.size()),
      weights_(outermost_.size(), 1),
      fixed_(triangles_in(query.fixed())),
      moving_(triangles_in(query.moving())),
      features_(fixed_, moving_, kFeatureRoom),
      near_(kFirstRoom),
      nearest_(kFeatureRoom) {
  const RigidMove then(pose);
  for (const Vector& point : outermost_) outermost_then_.push_back(then(point));
}

// Finds the near pairs. Returns whether the query answered.
bool EscapeSteps::look(const Vector6& at) {
  const double margin = kReachOfTrust * trust_ + skin_;
  for (;;) {
    const NearPairsResult found = query_.near_pairs(frame_.pose_at(at), margin, near_);
    near_count_ = static_cast<std::size_t>(std::min<std::uint64_t>(found.near_pairs, near_.size()));
    if (found.status == QueryStatus::kBusy) free_.end_busy();
    if (found.status != QueryStatus::kDone) return false;
    if (!found.truncated || near_.size() >= kMostRoom) return true;
    near_.resize(2 * near_.size());
  }
}

// Makes the bounds of a step. Turns count as ways at the radius.
void EscapeSteps::bound(const Vector6& at, FeatureList::Which which, bool turns) {
  features_.find(std::span(near_).first(near_count_), frame_.pose_at(at),
                 kReachOfTrust * trust_ + skin_, which, kFeatureSlope);
  const Vector middle = frame_.load_at(at);
  nearest_.clear();
  for (const Feature& feature : features_.features()) {
    Vector6 along = frame_.bound_at(at, feature.normal, difference(feature.moving_point, middle));
    for (Eigen::Index i = 3; i < 6; ++i) along[i] = turns ? along[i] / radius_ : 0;
    nearest_.add(along, std::min(skin_ - feature.gap, 0.0));
  }
}

void EscapeSteps::find_ways(const Vector6& at) {
  const RigidMove now(frame_.pose_at(at));
  const Vector middle = frame_.load_at(at);
  Vector turns[3];
  for (Eigen::Index i = 0; i < 3; ++i) turns[i] = frame_.turn_at(at, Vector::Unit(i) / radius_);
  for (std::size_t k = 0; k < ways_.size(); ++k) {
    const Vector place = now(outermost_[k]), arm = difference(place, middle);
    ways_[k].way = difference(place, outermost_then_[k]);
    for (std::size_t i = 0; i < 3; ++i) ways_[k].by_turn[i] = cross_in_order(turns[i], arm);
  }
}

double EscapeSteps::longest(const Vector6& at) const noexcept {
  const RigidMove now(frame_.pose_at(at));
  double most = 0;  // a square
  for (std::size_t k = 0; k < outermost_.size(); ++k) {
    most = std::max(most, square_in_order(difference(now(outermost_[k]), outermost_then_[k])));
  }
  return std::sqrt(most);
}

// The weighted sum of the squares of the ways, as a form of the scaled coordinates.
Matrix6 EscapeSteps::metric() const noexcept {
  Matrix6 sum = Matrix6::Zero();
  double total = 0;
  for (const double weight : weights_) total += weight;
  for (std::size_t k = 0; k < ways_.size(); ++k) {
    const double weight = weights_[k] / total;
    Vector columns[6];
    for (Eigen::Index i = 0; i < 3; ++i) {
      columns[i] = Vector::Unit(i);
      columns[3 + i] = ways_[k].by_turn[i];
    }
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index j = 0; j < 6; ++j)
        sum(i, j) += weight * dot_in_order(columns[i], columns[j]);
    }
  }
  // A body may be flat, or a line, round which a turn moves nothing.
  for (Eigen::Index i = 0; i < 6; ++i) sum(i, i) += 1e-6;
  return sum;
}

// Returns the way of an outermost point after a step, to first order.
Eigen::Vector3d EscapeSteps::way_after(std::size_t point, const Vector6& step) const noexcept {
  Vector way = sum(ways_[point].way, {step[0], step[1], step[2]});
  for (Eigen::Index i = 0; i < 3; ++i) add_to(way, scaled(step[3 + i], ways_[point].by_turn[i]));
  return way;
}

// Returns a step within the trust after which the longest way is shorter, to first order.
EscapeSteps::Step EscapeSteps::step(const Vector6& at, bool turns) {
  Vector6 motion = at;
  for (Eigen::Index i = 3; i < 6; ++i) motion[i] *= radius_;
  Step best{Vector6::Zero(), std::numeric_limits<double>::infinity()};
  double part = 1;  // of the way back to the given pose
  for (int round = 0; round < kWeightings; ++round) {
    const Matrix6 form = turns ? metric() : Matrix6(Matrix6::Identity());
    Vector6 made = Vector6::Zero();
    for (int i = 0; i < kPartHalvings; ++i, part *= 0.5) {
      if (!nearest_.solve(form, Vector6(-part * motion), 1e-7 * trust_)) return best;
      made = nearest_.motion();
      double most = 0;
      for (std::size_t k = 0; k < ways_.size(); ++k) {
        most = std::max(most, length_in_order(difference(way_after(k, made), ways_[k].way)));
      }
      if (most <= trust_) break;
    }
    double longest = 0;
    for (std::size_t k = 0; k < ways_.size(); ++k) {
      longest = std::max(longest, length_in_order(way_after(k, made)));
    }
    if (longest < best.longest) best = {made, longest};
    if (!turns || !(longest > 0)) break;
    double most = 0;
    for (std::size_t k = 0; k < ways_.size(); ++k) {
      weights_[k] *= square_in_order(way_after(k, made)) / (longest * longest);
      most = std::max(most, weights_[k]);
    }
    for (double& weight : weights_) weight = std::max(weight / most, kLeastWeight);
    part = std::min(2 * part, 1.0);
  }
  return best;
}

// Takes back what a motion has too much along its line.
void EscapeSteps::touch(Vector6& at) {
  const double length = longest(at);
  if (!(length > 0)) return;
  const double part = shortened(
      free_, [&](double s) { return frame_.pose_at(Vector6(s * at)); }, tolerance_ / length);
  at *= part;
}

void EscapeSteps::shorten(Vector6& at, bool turns) {
  std::fill(weights_.begin(), weights_.end(), 1.0);
  for (int round = 0; round < kEscapeRounds && !free_.is_ended(); ++round) {
    double length = longest(at);
    const double first = length;
    trust_ = std::max(kTrustBegins * length, 4 * skin_);
    bool is_seen = false;
    for (int i = 0; i < kEscapeSteps && !free_.is_ended(); ++i) {
      if (!is_seen && !look(at)) return;
      is_seen = true;
      find_ways(at);
      bool is_made = false;
      for (const auto which : {FeatureList::Which::kMinima, FeatureList::Which::kAll}) {
        bound(at, which, turns);
        const Step made = step(at, turns);
        Vector6 to = at;
        for (Eigen::Index k = 0; k < 6; ++k) {
          to[k] += k < 3 ? made.motion[k] : made.motion[k] / radius_;
        }
        const double gain = length - made.longest, gained = length - longest(to);
        if (!(gain > kWorthAStep * skin_)) continue;
        if (!(gained > kStepKept * gain) || !free_.at(frame_.pose_at(to))) continue;
        at = to;
        length -= gained;
        is_made = true;
        is_seen = false;
        if (gained > kStepGood * gain && size_of_step(made.motion) > kStepLong * trust_)
          trust_ *= 2;
        break;
      }
      if (is_made) continue;
      trust_ *= 0.25;
      if (trust_ < kTrustEnds * skin_) break;
    }
    touch(at);
    if (!(first - longest(at) > tolerance_)) return;
  }
}

}  // namespace ist
