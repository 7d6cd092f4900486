#include "ist/haptics/effects/effect.h"

namespace ist {

void Response::add(const Eigen::Vector3d& arm, const Eigen::Vector3d& force,
                   const Eigen::Matrix3d& change) noexcept {
  wrench.head<3>() += force;
  wrench.tail<3>() += arm.cross(force);
  // The point moves by t + w × arm = t - [arm] w, and the torque of the force f is [arm] f.
  Eigen::Matrix3d cross;
  cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  const Eigen::Matrix3d turned = cross * change;
  stiffness.topLeftCorner<3, 3>() += change;
  stiffness.bottomLeftCorner<3, 3>() += turned;
  stiffness.topRightCorner<3, 3>() += turned.transpose();
  stiffness.bottomRightCorner<3, 3>() -= turned * cross;
}

}  // namespace ist
