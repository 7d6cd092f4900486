#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace ist {

using Triangle = std::array<std::uint32_t, 3>;

// Three plain doubles whatever instruction set the including code is compiled for.
static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) &&
              alignof(Eigen::Vector3d) == alignof(double));

/// A surface as indexed triangles. Coordinates are in mesh units (millimetres by habit), in the
/// body's own frame. A triangle's outer side is the one from which its vertices turn counter
/// clockwise.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;  ///< each index is below vertices.size()
};

}  // namespace ist
