#include "ist/query/world/broad_phase.h"

#include <cmath>

#include "ist/base/ordered_vector.h"
#include "ist/query/relative_pose.h"

namespace ist {
namespace {

// The pads of a ball, in parts of its radius and margin, and of the place of the body
// (docs/guarantees.md, Broad phase of a world).
constexpr double kOfRadius = 0x1p-16, kOfPlace = 0x1p-44;
// Beyond so many moves a body, sorting anew is faster.
constexpr std::size_t kMostMoves = 8;

double largest_of(const Eigen::Vector3d& v) noexcept {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

}  // namespace

BodyBall ball_of(const SphereTree& tree, const BodyPose& pose, double reach,
                 double contacts) noexcept {
  const Eigen::Vector3d origin = tree.origin();
  const double radius = tree.bounding_radius();
  const double place = (largest_of(origin) + largest_of(pose.translation)) + radius;
  BodyBall ball;
  ball.centre = moved(RelativePose{pose.rotation, pose.translation}, origin);
  ball.radius = (radius + kOfRadius * radius) + kOfPlace * place;
  ball.margin = (1 + kOfRadius) * 0.5 * (reach + contacts * tree.voxel_size());
  return ball;
}

DistanceInterval distance_of(const BodyBall& a, const BodyBall& b) noexcept {
  const double between = length_in_order(difference(b.centre, a.centre));
  const double radii = a.radius + b.radius;
  if (!(between + radii <= kLargestDistance)) return {0, kLargestDistance};
  return {std::max(0.0, between - radii), between + radii};
}

void BroadPhase::reserve(std::size_t bodies) {
  balls_.reserve(bodies);
  there_.reserve(bodies);
  places_.reserve(bodies);
}

void BroadPhase::add() noexcept {
  balls_.push_back({});
  there_.push_back(0);
  places_.push_back({0, 0, static_cast<BodyIndex>(places_.size())});
  sorted_ = false;
}

void BroadPhase::set(BodyIndex body, const BodyBall& ball) noexcept {
  balls_[body] = ball;
  there_[body] = 1;
  sorted_ = false;
}

void BroadPhase::take_out(BodyIndex body) noexcept {
  there_[body] = 0;
  sorted_ = false;
}

// By >, so that what no double holds counts as near.
bool BroadPhase::meet(const BodyBall& a, const BodyBall& b) noexcept {
  const double reach = (a.radius + b.radius) + (a.margin + b.margin);
  return !(square_in_order(difference(b.centre, a.centre)) > reach * reach);
}

void BroadPhase::sort() noexcept {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), spread = Eigen::Vector3d::Zero();
  double count = 0;
  for (BodyIndex body = 0; body < balls_.size(); ++body) {
    if (!has(body)) continue;
    add_to(mean, balls_[body].centre);
    count += 1;
  }
  for (BodyIndex body = 0; body < balls_.size(); ++body) {
    if (!has(body)) continue;
    const Eigen::Vector3d away = difference(balls_[body].centre, scaled(1 / count, mean));
    for (Eigen::Index k = 0; k < 3; ++k) spread[k] += away[k] * away[k];
  }
  Eigen::Index axis = 0;
  for (Eigen::Index k = 1; k < 3; ++k) {
    if (spread[k] > spread[axis]) axis = k;
  }
  for (Place& place : places_) {
    const BodyBall& ball = balls_[place.body];
    const double centre = ball.centre[axis], half = ball.radius + ball.margin;
    constexpr double kNowhere = std::numeric_limits<double>::infinity();
    place.low =
        has(place.body) ? std::clamp(centre - half, -kLargestDistance, kLargestDistance) : kNowhere;
    place.high =
        has(place.body) ? std::clamp(centre + half, -kLargestDistance, kLargestDistance) : kNowhere;
  }
  const auto before = [](const Place& a, const Place& b) {
    return a.low < b.low || (a.low == b.low && a.body < b.body);
  };
  std::size_t moves = kMostMoves * places_.size();
  for (std::size_t i = 1; i < places_.size(); ++i) {
    const Place place = places_[i];
    std::size_t to = i;
    for (; to > 0 && before(place, places_[to - 1]) && moves > 0; --to, --moves) {
      places_[to] = places_[to - 1];
    }
    places_[to] = place;
    if (moves > 0) continue;
    std::sort(places_.begin(), places_.end(), before);
    break;
  }
  sorted_ = true;
}

}  // namespace ist
