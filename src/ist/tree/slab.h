#pragma once

#include <Eigen/Core>

namespace ist {

/// The points x with |normal · (x - c) - offset| <= half, where c is the centre of the ball that
/// the slab goes with. The normal is no longer than 1.
struct Slab {
  Eigen::Vector3d normal;
  double offset, half;
};

}  // namespace ist
