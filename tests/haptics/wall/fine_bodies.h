#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>

#include "ist/mesh/mesh.h"

namespace ist::test {

/// A closed box about the origin whose faces have `n` times `n` squares of two triangles, normals
/// outward.
[[nodiscard]] inline TriangleMesh fine_box(const Eigen::Vector3d& sizes, int n) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> at;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [found, is_new] = at.try_emplace(p, static_cast<std::uint32_t>(at.size()));
    if (is_new) {
      const Eigen::Vector3d part = Eigen::Vector3d(p[0], p[1], p[2]) / n;
      mesh.vertices.push_back(sizes.cwiseProduct(part - Eigen::Vector3d::Constant(0.5)));
    }
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int u, int v) {
            std::array<int, 3> p{};
            p[axis] = side;
            p[(axis + 1) % 3] = side == n ? u : v;
            p[(axis + 2) % 3] = side == n ? v : u;
            return vertex(p);
          };
          mesh.triangles.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
          mesh.triangles.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
        }
      }
    }
  }
  return mesh;
}

}  // namespace ist::test
