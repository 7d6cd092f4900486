#include "ist/scene/free_start.h"

#include <algorithm>

namespace ist {

FreeStart::FreeStart(const SphereTree& fixed, const SphereTree& held,
                     const TriangleMesh* fixed_mesh, const TriangleMesh* held_mesh)
    : query_(fixed, held),
      voxel_(std::min(fixed.voxel_size(), held.voxel_size())),
      farthest_(2 * (fixed.bounding_radius() + held.bounding_radius())) {
  if (fixed_mesh != nullptr && held_mesh != nullptr) inside_.emplace(*fixed_mesh, *held_mesh);
}

FreeStart::State FreeStart::at(const Eigen::Isometry3d& pose) noexcept {
  if (const IntersectionResult found = query_.intersects(pose);
      found.status != QueryStatus::kDone || found.answer != Answer::kNo)
    return State::kIntersecting;
  if (inside_ && inside_->at(pose) != Inside::kNone) return State::kInside;
  return State::kFree;
}

std::optional<double> FreeStart::open_distance(const Eigen::Isometry3d& pose,
                                               const Eigen::Vector3d& axis) noexcept {
  if (at(pose) == State::kFree) return 0;
  Eigen::Isometry3d moved = pose;
  for (double distance = voxel_; distance <= farthest_; distance += voxel_) {
    moved.translation() = pose.translation() + distance * axis;
    if (at(moved) != State::kFree) continue;
    moved.translation() = pose.translation() + (distance + voxel_) * axis;
    if (at(moved) == State::kFree) return distance + voxel_;
  }
  return std::nullopt;
}

}  // namespace ist
