#pragma once

#include <Eigen/Core>

#include "ist/query/exact/triangle_bounds.h"

namespace ist::test {

/// Whether a point is in a box, faces included.
[[nodiscard]] inline bool holds(const FloatBox& box, const Eigen::Vector3d& p) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = p[static_cast<Eigen::Index>(i)];
    if (x < double{box.low[i]} || x > double{box.high[i]}) return false;
  }
  return true;
}

}  // namespace ist::test
