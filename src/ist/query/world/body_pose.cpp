#include "ist/query/world/body_pose.h"

#include <cmath>

#include "ist/base/compensated.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/pose.h"

namespace ist {

std::optional<BodyPose> body_pose(const Eigen::Isometry3d& pose) noexcept {
  const std::optional<Eigen::Isometry3d> rigid = project_to_rigid(pose);
  if (!rigid) return std::nullopt;
  return BodyPose{rigid->linear(), rigid->translation()};
}

BodyPose between(const BodyPose& a, const BodyPose& b) noexcept {
  BodyPose pose;
  for (Eigen::Index i = 0; i < 3; ++i) {
    CompensatedSum way;
    for (Eigen::Index k = 0; k < 3; ++k) {
      way.add_product(a.rotation(k, i), b.translation[k]);
      way.add_product(-a.rotation(k, i), a.translation[k]);
    }
    pose.translation[i] = way.value();
    if (!std::isfinite(pose.translation[i])) {  // near the end of double's range
      const Eigen::Vector3d apart = difference(b.translation, a.translation);
      pose.translation[i] = dot_in_order(a.rotation.col(i), apart);
    }
    for (Eigen::Index j = 0; j < 3; ++j) {
      CompensatedSum turn;
      for (Eigen::Index k = 0; k < 3; ++k) turn.add_product(a.rotation(k, i), b.rotation(k, j));
      pose.rotation(i, j) = turn.value();
    }
  }
  return pose;
}

Eigen::Isometry3d to_isometry(const BodyPose& pose) noexcept {
  Eigen::Isometry3d made = Eigen::Isometry3d::Identity();
  made.linear() = pose.rotation;
  made.translation() = pose.translation;
  return made;
}

}  // namespace ist
