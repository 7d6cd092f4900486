#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "ist/query/results.h"
#include "ist/query/world/body_pose.h"
#include "ist/query/world/world.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// The distance of bodies so far apart that no double holds it.
inline constexpr double kLargestDistance = std::numeric_limits<double>::max();

/// A ball round a body in world coordinates, in double: nothing of the body, nor any bound of its
/// tree, extends beyond it, whatever is rounded (docs/guarantees.md, Broad phase of a world).
struct BodyBall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< the origin of the tree's frame
  double radius = 0;                                 ///< with the pad
  double margin = 0;  ///< this body's share of the distance at which a pair is near
};

/// Returns the ball of a body at a pose.
///
/// @param reach    pairs are near whose bounds are no farther apart, mesh units
/// @param contacts the reach of contacts, in mean voxel sizes of two bodies
[[nodiscard]] BodyBall ball_of(const SphereTree& tree, const BodyPose& pose, double reach,
                               double contacts) noexcept;

/// Returns the distance between the surfaces of two bodies as far as their balls tell it.
[[nodiscard]] DistanceInterval distance_of(const BodyBall& a, const BodyBall& b) noexcept;

/// Finds pairs of balls that are near each other: sweep and prune along the axis on which the
/// balls' centres spread most. Bodies stay sorted from call to call, which is a matter of time
/// alone. Source: D. Baraff, Dynamic Simulation of Non-Penetrating Rigid Bodies, 1992.
class BroadPhase {
 public:
  /// Makes room for so many bodies.
  void reserve(std::size_t bodies);
  /// Adds a body, without a ball. Precondition: there is room.
  void add() noexcept;
  void set(BodyIndex body, const BodyBall& ball) noexcept;
  /// Takes a body out until it is set again.
  void take_out(BodyIndex body) noexcept;
  [[nodiscard]] const BodyBall& ball(BodyIndex body) const noexcept { return balls_[body]; }
  [[nodiscard]] bool has(BodyIndex body) const noexcept { return there_[body] != 0; }

  /// Calls visit(BodyPair) once for each pair of balls that are no farther apart than their
  /// margins, in no order.
  template <class Visit>
  void near(Visit visit) noexcept {
    const double within = 0;
    sweep(within, [&](BodyPair pair) {
      if (meet(balls_[pair.a], balls_[pair.b])) visit(pair);
    });
  }
  /// Calls visit(BodyPair, DistanceInterval) for each pair whose balls are no farther apart than
  /// the least upper end of all pairs that were visited, and for some others; in no order. visit()
  /// returns whether the pair counts.
  template <class Visit>
  void nearest(Visit visit) noexcept;

 private:
  struct Place {
    double low, high;
    BodyIndex body;
  };
  [[nodiscard]] static bool meet(const BodyBall& a, const BodyBall& b) noexcept;
  void sort() noexcept;
  template <class Visit>
  void sweep(const double& within, Visit visit) noexcept;

  std::vector<BodyBall> balls_;
  std::vector<char> there_;
  std::vector<Place> places_;  // by their low ends, then by body; those that are not there last
  bool sorted_ = true;
};

// Visits all pairs that are no farther apart along the axis than `within`, which may shrink.
template <class Visit>
void BroadPhase::sweep(const double& within, Visit visit) noexcept {
  if (!sorted_) sort();
  const std::size_t count = places_.size();
  for (std::size_t i = 0; i < count && has(places_[i].body); ++i) {
    const Place& first = places_[i];
    for (std::size_t j = i + 1; j < count && has(places_[j].body); ++j) {
      const Place& second = places_[j];
      if (second.low - first.high > within) break;
      visit(first.body < second.body ? BodyPair{first.body, second.body}
                                     : BodyPair{second.body, first.body});
    }
  }
}

template <class Visit>
void BroadPhase::nearest(Visit visit) noexcept {
  double within = std::numeric_limits<double>::infinity();
  const auto look = [&](BodyPair pair) {
    const DistanceInterval distance = distance_of(balls_[pair.a], balls_[pair.b]);
    if (distance.lower > within || !visit(pair, distance)) return;
    within = std::min(within, distance.upper);
  };
  sweep(within, look);
}

}  // namespace ist
