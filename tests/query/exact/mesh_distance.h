#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ist/mesh/triangle_mesh.h"
#include "ist/query/exact/triangle_distance.h"

namespace ist::test {

/// How far two surfaces are apart, by all pairs of their triangles; 0 where two of them meet.
[[nodiscard]] inline double mesh_distance(const TriangleMesh& fixed, const TriangleMesh& moving,
                                          const Eigen::Isometry3d& pose) {
  double least = HUGE_VAL;
  for (const Triangle& s : fixed.triangles) {
    for (const Triangle& t : moving.triangles) {
      TriangleCorners a, b;
      for (std::size_t i = 0; i < 3; ++i) {
        a[i] = fixed.vertices[s[i]];
        b[i] = pose * moving.vertices[t[i]];
      }
      if (box_distance_squared(a, b) >= least * least) continue;
      if (triangles_meet(a, b)) return 0;
      least = std::min(least, std::sqrt(distance_squared(a, b)));
    }
  }
  return least;
}

}  // namespace ist::test
