#include "ist/query/coherent/pose_track.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace ist {

void PoseTrack::add(const RelativePose& pose) noexcept {
  poses_[next_] = pose;
  next_ = (next_ + 1) % kSize;
  count_ = std::min(count_ + 1, kSize);
}

double PoseTrack::speed(const MotionBound& bound, double reach) const noexcept {
  if (count_ < 2) return std::numeric_limits<double>::infinity();
  return std::max(bound.between(back(1), back(0), reach), drift(bound, reach));
}

double PoseTrack::drift(const MotionBound& bound, double reach) const noexcept {
  if (count_ < 2) return std::numeric_limits<double>::infinity();
  return bound.between(back(past()), back(0), reach) / static_cast<double>(past());
}

RelativePose PoseTrack::ahead(double ticks) const noexcept {
  RelativePose pose = back(0);
  if (past() == 0) return pose;
  const RelativePose& before = back(past());
  const double part = ticks / static_cast<double>(past());
  Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.rotation * before.rotation.transpose()));
  turn.angle() *= part;
  pose.rotation = turn.toRotationMatrix() * pose.rotation;
  pose.translation += part * (pose.translation - before.translation);
  return pose;
}

}  // namespace ist
