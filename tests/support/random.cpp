#include "support/random.h"

#include <Eigen/Geometry>
#include <cmath>

namespace ist::test {

Eigen::Vector3d Random::point(double low, double high) {
  const double x = uniform(low, high), y = uniform(low, high), z = uniform(low, high);
  return {x, y, z};
}

Eigen::Vector3d Random::point_on_grid(double low, double high, double step) {
  const Eigen::Vector3d p = point(low, high);
  return {std::floor(p[0] / step) * step, std::floor(p[1] / step) * step,
          std::floor(p[2] / step) * step};
}

Eigen::Vector3d Random::direction() {
  while (true) {
    const Eigen::Vector3d p = point(-1, 1);
    const double length2 = p.squaredNorm();
    if (length2 > 0.01 && length2 <= 1) return p / std::sqrt(length2);
  }
}

Eigen::Matrix3d Random::rotation() {
  const Eigen::Vector3d x = direction();
  Eigen::Vector3d y = x.cross(direction());
  while (y.squaredNorm() < 0.01) y = x.cross(direction());
  y /= std::sqrt(y.squaredNorm());
  Eigen::Matrix3d rotation;
  rotation << x, y, x.cross(y);
  return rotation;
}

}  // namespace ist::test
