#pragma once

#include <Eigen/Core>

namespace ist {

struct Ball {
  Eigen::Vector3d centre;
  double radius;
};

}  // namespace ist
