#include "ist/scene/free_start.h"

#include <algorithm>

namespace ist {
namespace {

// All pairs have a query at once, beside those of the loop: these are small, and slower by a tenth.
QueryOptions small_query() {
  QueryOptions options;
  options.frontier_pairs = 1 << 12;
  return options;
}

}  // namespace

void FreeStart::add(const SphereTree& fixed, const SphereTree& held, const TriangleMesh* fixed_mesh,
                    const TriangleMesh* held_mesh, const Eigen::Isometry3d& pose,
                    const Eigen::Vector3d& axis) {
  const double voxel = std::min(fixed.voxel_size(), held.voxel_size());
  voxel_ = pairs_.empty() ? voxel : std::min(voxel_, voxel);
  farthest_ = std::max(farthest_, 2 * (fixed.bounding_radius() + held.bounding_radius()));
  pairs_.push_back(
      {Query(fixed, held, small_query()), std::nullopt, {pose.linear(), pose.translation()}, axis});
  if (fixed_mesh != nullptr && held_mesh != nullptr) {
    pairs_.back().inside.emplace(*fixed_mesh, *held_mesh);
  }
}

std::optional<FreeStart::Flaw> FreeStart::flaw(double distance) noexcept {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    CheckedPair& pair = pairs_[i];
    Eigen::Isometry3d pose = pair.pose.isometry();
    pose.translation() += distance * pair.axis;
    if (const IntersectionResult found = pair.query.intersects(pose);
        found.status != QueryStatus::kDone || found.answer != Answer::kNo) {
      return Flaw{i, Way::kIntersecting};
    }
    if (pair.inside && pair.inside->at(pose) != Inside::kNone) return Flaw{i, Way::kInside};
  }
  return std::nullopt;
}

std::optional<double> FreeStart::open_distance() noexcept {
  double distance = voxel_;
  while (distance <= farthest_) {
    if (!flaw(distance) && !flaw(distance + voxel_)) return distance + voxel_;
    distance += voxel_;
  }
  return std::nullopt;
}

}  // namespace ist
