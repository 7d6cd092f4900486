#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/query/exact/triangle_distance.h"
#include "ist/query/results.h"

namespace ist::test {

/// What the error of a distance of two triangles goes by (kTriangleDistanceError).
[[nodiscard]] inline double longest_edge(const TriangleMesh& mesh) {
  double longest = 0;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm());
    }
  }
  return longest;
}

/// How far two surfaces are apart, by all pairs of their triangles; 0 where two of them meet.
[[nodiscard]] inline double mesh_distance(const TriangleMesh& fixed, const TriangleMesh& moving,
                                          const Eigen::Isometry3d& pose) {
  std::vector<TriangleCorners> moved;
  for (const Triangle& t : moving.triangles) {
    moved.push_back(
        {pose * moving.vertices[t[0]], pose * moving.vertices[t[1]], pose * moving.vertices[t[2]]});
  }
  double least = HUGE_VAL;
  for (const Triangle& s : fixed.triangles) {
    const TriangleCorners a = {fixed.vertices[s[0]], fixed.vertices[s[1]], fixed.vertices[s[2]]};
    for (const TriangleCorners& b : moved) {
      if (box_distance_squared(a, b) >= least * least) continue;
      if (triangles_meet(a, b)) return 0;
      least = std::min(least, std::sqrt(ist::distance_squared(a, b)));
    }
  }
  return least;
}

/// How far a distance is outside an interval that should hold it; 0 where it is not.
[[nodiscard]] inline double outside(const DistanceInterval& gap, double distance) {
  return std::max({0.0, gap.lower - distance, distance - gap.upper});
}

}  // namespace ist::test
