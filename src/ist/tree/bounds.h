#pragma once

#include <Eigen/Core>

namespace ist {

struct Ball {
  Eigen::Vector3d centre;
  double radius;
};

/// A slab: the points x with |normal · (x - c) - offset| <= half, where c is the centre of the
/// slab's ball. The normal has length at most 1.
struct Slab {
  Eigen::Vector3d normal;
  double offset, half;
};

}  // namespace ist
