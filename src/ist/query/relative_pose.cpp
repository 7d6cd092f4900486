#include "ist/query/relative_pose.h"

#include <cmath>

#include "ist/base/compensated.h"
#include "ist/base/pose.h"

namespace ist {

std::optional<RelativePose> relative_pose(const Eigen::Isometry3d& pose, const Lattice& fixed,
                                          const Lattice& moving) noexcept {
  const std::optional<Eigen::Isometry3d> rigid = project_to_rigid(pose);
  if (!rigid) return std::nullopt;
  RelativePose result{rigid->linear(), {}};
  // The origin of a frame is the grid's corner plus half the root cube's edge: exact as a pair of
  // numbers, rounded as one.
  const double moving_half = 0.5 * moving.edge(moving.depth);
  const double fixed_half = 0.5 * fixed.edge(fixed.depth);
  for (Eigen::Index i = 0; i < 3; ++i) {
    CompensatedSum sum;
    sum.add(rigid->translation()[i]);
    sum.add(-fixed.corner[static_cast<std::size_t>(i)]);
    sum.add(-fixed_half);
    for (Eigen::Index j = 0; j < 3; ++j) {
      sum.add_product(result.rotation(i, j), moving.corner[static_cast<std::size_t>(j)]);
      sum.add_product(result.rotation(i, j), moving_half);
    }
    // Only a translation near the end of double's range overflows; beside it no corner counts.
    const double value = sum.value();
    result.translation[i] = std::isfinite(value) ? value : rigid->translation()[i];
  }
  return result;
}

}  // namespace ist
