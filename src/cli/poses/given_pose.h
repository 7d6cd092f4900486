#pragma once

#include <Eigen/Geometry>

namespace ist::cli {

/// A pose that a user gave.
struct GivenPose {
  Eigen::Isometry3d pose;
  double rotation_error = 0;  ///< of the matrix as it was given (rotation_error)
};

}  // namespace ist::cli
