#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace ist::test {

/// Returns the angle between two vectors of any length, in degrees.
inline double angle_in_degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * (180 / 3.141592653589793);
}

}  // namespace ist::test
