#pragma once

#include "ist/mesh/mesh.h"

namespace ist {

/// Adds 4 * `quarter` vertices on the circle of `radius` round the z axis at height `z`,
/// counterclockwise from the x axis on; returns the index of the first one. Pythagorean triples
/// give the coordinates without a sine, so the bits are the same everywhere; neighbours are at most
/// 2/`quarter` radians apart.
inline std::uint32_t add_ring(TriangleMesh& mesh, int quarter, double radius, double z) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector2d& x : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1),
                                   Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, -1)}) {
    const Eigen::Vector2d y(-x.y(), x.x());
    for (int i = 0; i < quarter; ++i) {
      const double t = static_cast<double>(i) / quarter;
      const Eigen::Vector2d at = radius / (1 + t * t) * ((1 - t * t) * x + 2 * t * y);
      mesh.vertices.emplace_back(at.x(), at.y(), z);
    }
  }
  return first;
}

/// Joins two rings of add_ring by triangles. Seen from their outer side, the first ring runs to the
/// right and the second one lies above it.
inline void add_band(TriangleMesh& mesh, int quarter, std::uint32_t below, std::uint32_t above) {
  const auto sides = static_cast<std::uint32_t>(4 * quarter);
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t j = (i + 1) % sides;
    mesh.triangles.push_back({below + i, below + j, above + j});
    mesh.triangles.push_back({below + i, above + j, above + i});
  }
}

}  // namespace ist
