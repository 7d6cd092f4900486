#include "ist/query/pair_cache/pose_track.h"

#include <Eigen/Geometry>
#include <limits>

namespace ist {

void PoseTrack::add(const RelativePose& pose, const MotionBound& bound, double reach) noexcept {
  steps_[next_] = count_ > 0 ? bound.between(back(0), pose, reach) : 0;
  poses_[next_] = pose;
  next_ = (next_ + 1) % kSize;
  count_ = std::min(count_ + 1, kSize);
}

double PoseTrack::speed() const noexcept {
  if (count_ < 2) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t i = 0; i < past(kTicks); ++i) most = std::max(most, steps_[place(i)]);
  return most;
}

double PoseTrack::mean(const MotionBound& bound, double reach, std::size_t ticks) const noexcept {
  const std::size_t first = past(ticks);
  if (first == 0) return std::numeric_limits<double>::infinity();
  return bound.between(back(first), back(0), reach) / static_cast<double>(first);
}

RelativePose PoseTrack::ahead(double ticks) const noexcept {
  RelativePose pose = back(0);
  const std::size_t first = past(kTicks);
  if (first == 0) return pose;
  const RelativePose& before = back(first);
  const double part = ticks / static_cast<double>(first);
  Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.rotation * before.rotation.transpose()));
  turn.angle() *= part;
  pose.rotation = turn.toRotationMatrix() * pose.rotation;
  pose.translation += part * (pose.translation - before.translation);
  return pose;
}

}  // namespace ist
