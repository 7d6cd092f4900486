#include "ist/capi/ask.h"

namespace ist::capi {

Eigen::Isometry3d to_isometry(const double pose[16]) noexcept {
  Eigen::Isometry3d isometry;
  isometry.matrix() = Eigen::Map<const Eigen::Matrix4d>(pose);
  return isometry;
}

ist_status status_of(const Call& call, QueryStatus status) {
  switch (status) {
    case QueryStatus::kDone:
      return IST_OK;
    case QueryStatus::kInvalidPose:
      return call.fail(
          IST_POSE_INVALID,
          "pose is no rigid motion: give 16 finite numbers, column by column, with 0 0 "
          "0 1 as the last row and a rotation that is orthonormal to 1e-5");
    case QueryStatus::kNoTriangles:
      return call.fail(IST_TRIANGLES_MISSING,
                       "a tree has no triangles: build both with keep_triangles = 1");
  }
  return call.fail(IST_INTERNAL_ERROR, "a query's status that is none");
}

}  // namespace ist::capi
