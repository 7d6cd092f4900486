#include "ist/query/relative_pose.h"

#include <cmath>

#include "ist/base/compensated.h"
#include "ist/base/pose.h"

namespace ist {

std::optional<RelativePose> relative_pose(const Eigen::Isometry3d& pose, const FrameOrigin& fixed,
                                          const FrameOrigin& moving) noexcept {
  const std::optional<Eigen::Isometry3d> rigid = project_to_rigid(pose);
  if (!rigid) return std::nullopt;
  RelativePose result{rigid->linear(), {}};
  for (Eigen::Index i = 0; i < 3; ++i) {
    CompensatedSum sum;
    sum.add(rigid->translation()[i]);
    sum.add(-fixed.corner[static_cast<std::size_t>(i)]);
    sum.add(-fixed.half);
    for (Eigen::Index j = 0; j < 3; ++j) {
      sum.add_product(result.rotation(i, j), moving.corner[static_cast<std::size_t>(j)]);
      sum.add_product(result.rotation(i, j), moving.half);
    }
    // Only a translation near the end of double's range overflows; beside it no corner counts.
    const double value = sum.value();
    result.translation[i] = std::isfinite(value) ? value : rigid->translation()[i];
  }
  return result;
}

Eigen::Isometry3d to_isometry(const RelativePose& pose) noexcept {
  Eigen::Isometry3d made = Eigen::Isometry3d::Identity();
  made.linear() = pose.rotation;
  made.translation() = pose.translation;
  return made;
}

}  // namespace ist
