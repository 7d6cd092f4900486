#include "cli/answers/shared_point.h"

#include <array>
#include <cstddef>

#include "ist/mesh/nearest_point.h"

namespace ist::cli {

Eigen::Vector3d shared_point(const Bodies& bodies, const TrianglePair& pair,
                             const Eigen::Isometry3d& pose) {
  constexpr int kTurns = 2000;  // 0.2 ms
  const auto corners = [](const TriangleMesh& mesh, std::uint32_t triangle,
                          const Eigen::Isometry3d& place) {
    std::array<Eigen::Vector3d, 3> found;
    for (std::size_t i = 0; i < 3; ++i) {
      found[i] = place * mesh.vertices[mesh.triangles[triangle][i]];
    }
    return found;
  };
  const auto fixed = corners(*bodies.fixed.triangles(), pair.fixed, Eigen::Isometry3d::Identity());
  const auto moving = corners(*bodies.moving.triangles(), pair.moving, pose);
  // Nearest points of both in turn lead to a common point of two convex sets.
  Eigen::Vector3d point = (moving[0] + moving[1] + moving[2]) / 3;
  for (int turn = 0; turn < kTurns; ++turn) {
    point = nearest_on_triangle(moving, nearest_on_triangle(fixed, point).point).point;
  }
  return nearest_on_triangle(fixed, point).point;
}

}  // namespace ist::cli
