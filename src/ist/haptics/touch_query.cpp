#include "ist/haptics/touch_query.h"

#include <algorithm>

namespace ist {
namespace {

// So many whole leaf pairs have their full stiffness each (TouchPoint::share).
constexpr double kFullPairs = 10;

}  // namespace

Eigen::Isometry3d BodyFrames::query_pose(const Placement& tool) const noexcept {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Eigen::Matrix3d to_fixed = fixed.rotation.transpose();
  pose.linear() = to_fixed * tool.rotation;
  pose.translation() =
      to_fixed * ((tool.translation - fixed.translation) / unit - tool.rotation * tool_origin);
  return pose;
}

Eigen::Vector3d BodyFrames::to_scene(const Eigen::Vector3d& point) const noexcept {
  return fixed.rotation * (unit * point) + fixed.translation;
}

TouchQuery::TouchQuery(const SphereTree& fixed, const SphereTree& held, const BodyFrames& frames,
                       const TouchOptions& options)
    : frames_(frames),
      area_(fixed.lattice().voxel_size * held.lattice().voxel_size),
      query_(fixed, held,
             {.policy = options.policy,
              .target = {},
              .workers = options.workers,
              .period = options.period}),
      points_(fixed, held, options.policy,
              {.points = TouchSet::kMost,
               .least_depth = options.least_depth,
               .growth = options.growth}) {}

QueryResult TouchQuery::ask(const Placement& tool, const Budget& budget,
                            TouchSet& touches) noexcept {
  const Eigen::Isometry3d pose = frames_.query_pose(tool);
  QueryResult result = query_.contact_points(pose, points_, budget);
  if (result.status != QueryStatus::kDone || !result.complete) return result;
  reduce(tool, touches);
  return result;
}

void TouchQuery::measure_gap(const Placement& tool, const Budget& budget,
                             QueryResult& answer) noexcept {
  if (answer.contacts > 0) return;
  Budget left = budget;
  left.sphere_tests -= std::min(left.sphere_tests, answer.sphere_tests);
  const QueryResult measured = query_.collide(frames_.query_pose(tool), std::span<Contact>(), left);
  answer.gap = measured.gap;
  answer.sphere_tests += measured.sphere_tests;
}

void TouchQuery::reduce(const Placement& tool, TouchSet& touches) const noexcept {
  const ContactSums& sums = points_.sums();
  touches.clear();
  touches.count = sums.weight / area_;
  const double share = 1 / (area_ * std::max(1.0, touches.count / kFullPairs));

  const Eigen::Matrix3d& turn = frames_.fixed.rotation;
  const Eigen::Vector3d arm = frames_.to_scene(sums.about) - tool.translation;
  const Eigen::Vector3d force = turn * ((share * frames_.unit) * sums.spring.force);
  touches.spring.head<3>() = force;
  touches.spring.tail<3>() =
      turn * ((share * frames_.unit * frames_.unit) * sums.spring.torque) + arm.cross(force);

  const double least_depth = points_.scale().least_depth;
  for (const ContactPoint& point : points_.points()) {
    touches.add({frames_.to_scene(point.position) - tool.translation, turn * point.normal,
                 frames_.unit * std::max(0.0, point.depth - least_depth), share * point.weight});
  }
}

}  // namespace ist
