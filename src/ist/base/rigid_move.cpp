#include "ist/base/rigid_move.h"

namespace ist {

Eigen::Isometry3d inverse_of(const Eigen::Isometry3d& pose) noexcept {
  Eigen::Isometry3d turned_back = Eigen::Isometry3d::Identity();
  turned_back.linear() = pose.linear().transpose();
  Eigen::Isometry3d inverse = turned_back;
  inverse.translation() = -RigidMove(turned_back).turned(pose.translation());
  return inverse;
}

}  // namespace ist
