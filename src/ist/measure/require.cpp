#include "ist/measure/require.h"

#include <optional>

#include "ist/base/pose.h"
#include "ist/base/throw_error.h"

namespace ist {

void require_triangles(const SphereTree& tree, std::string_view body) {
  if (tree.triangles() != nullptr) return;
  throw_error(ErrorCode::kTrianglesMissing,
              "{}: the tree holds no triangles, of which measures are made: build it "
              "with its triangles",
              body);
}

Eigen::Isometry3d require_rigid(const Eigen::Isometry3d& pose, std::string_view name) {
  const std::optional<Eigen::Isometry3d> projected = project_to_rigid(pose);
  if (projected) return *projected;
  throw_error(ErrorCode::kPoseInvalid, "{}: it is no rigid motion: {}", name, why_not_rigid(pose));
}

void require_tolerance(double tolerance) {
  if (tolerance >= 0) return;  // no NaN
  throw_error(ErrorCode::kArgumentInvalid,
              "tolerance: {} is no width of an interval: give 0 or more", tolerance);
}

}  // namespace ist
