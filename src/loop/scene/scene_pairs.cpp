#include "loop/scene/scene_pairs.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "loop/scene/scene_lines.h"

namespace ist {
namespace {

double length(const Eigen::Vector3d& v) { return std::sqrt(v.squaredNorm()); }

// The distance of a point from the way between two others.
double distance_from_leg(const Eigen::Vector3d& point, const Eigen::Vector3d& from,
                         const Eigen::Vector3d& to) {
  const Eigen::Vector3d way = to - from;
  const double square = way.squaredNorm();
  const double part = square > 0 ? std::clamp((point - from).dot(way) / square, 0.0, 1.0) : 0.0;
  return length(point - (from + part * way));
}

}  // namespace

std::vector<HandPair> pairs_of(const std::vector<LoadedBody>& bodies) {
  std::vector<HandPair> pairs;
  for (std::size_t fixed = 0; fixed < bodies.size(); ++fixed) {
    for (std::size_t held = 0; held < bodies.size(); ++held) {
      if (fixed == held || !bodies[fixed].may_be_fixed() || !bodies[held].may_be_held()) continue;
      pairs.push_back({fixed, held});
    }
  }
  return pairs;
}

PlanReach::PlanReach(const std::vector<Waypoint>& plan, const Placement& start) {
  if (plan.empty()) return;
  poses_.push_back(start);
  for (const Waypoint& waypoint : plan) poses_.push_back(waypoint.pose);
  Eigen::AlignedBox3d box;
  for (const Placement& pose : poses_) box.extend(pose.translation);
  extent_ = length(box.diagonal());
}

bool PlanReach::keeps_apart(const HandBodies& bodies, const HandPair& pair, double distance) const {
  if (poses_.empty()) return false;
  const auto [centre, radius] = bodies.ball(pair.fixed);
  const double reach = radius + bodies.held_radius() + extent_ + distance;
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    if (distance_from_leg(centre, poses_[i - 1].translation, poses_[i].translation) <= reach) {
      return false;
    }
  }
  return true;
}

Plan plan_of(const SceneBody& body, const BodyHome& home, double unit) {
  std::vector<Waypoint> plan = body.script;
  for (Waypoint& waypoint : plan) {
    waypoint.pose = home.moved(waypoint.pose);
    waypoint.pose.translation -= unit * (waypoint.pose.rotation * home.origin);
  }
  return Plan(std::move(plan));
}

double step_of(const Scene& scene, const LoadedBody& body, double radius, double dt,
               double longest) {
  const std::vector<Waypoint>& script = body.named->script;
  double most = 0;
  for (std::size_t i = 1; i < script.size(); ++i) {
    const Vector6 motion = motion_between(script[i - 1].pose, script[i].pose);
    // The turn has a speed of at most 4/3 of the mean (Plan).
    const double way = length(motion.head<3>()) + 4.0 / 3 * radius * length(motion.tail<3>());
    const double step = way / (script[i].time - script[i - 1].time) * dt;
    most = std::max(most, step);
    if (step <= longest) continue;
    fail_at(scene, body.table + ".script",
            fmt::format(
                "{}: from {} s to {} s, {} moves by up to {:.3g} m a tick, and half a voxel "
                "is {:.3g} m: give the motion more time, or the bodies larger voxels",
                body.named->script_file.empty() ? "the script" : body.named->script_file.string(),
                script[i - 1].time, script[i].time, body.named->name, step, longest));
  }
  return most;
}

}  // namespace ist
