#include "ist/sweep/turn.h"

#include "ist/base/ordered_vector.h"

namespace ist {

Eigen::Matrix3d rotation_of(double w, double x, double y, double z) noexcept {
  const double scale = 2 / ((w * w + x * x) + (y * y + z * z));
  const double xx = scale * x * x, yy = scale * y * y, zz = scale * z * z;
  const double xy = scale * x * y, xz = scale * x * z, yz = scale * y * z;
  const double wx = scale * w * x, wy = scale * w * y, wz = scale * w * z;
  Eigen::Matrix3d rotation;
  rotation << 1 - (yy + zz), xy - wz, xz + wy,  //
      xy + wz, 1 - (xx + zz), yz - wx,          //
      xz - wy, yz + wx, 1 - (xx + yy);
  return rotation;
}

Eigen::Isometry3d turn_about(const Eigen::Matrix3d& rotation,
                             const Eigen::Vector3d& about) noexcept {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotation;
  for (int row = 0; row < 3; ++row) {
    motion(row, 3) = about[row] - dot_in_order(rotation.row(row), about);
  }
  return motion;
}

}  // namespace ist
