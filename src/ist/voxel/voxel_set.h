#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ist/voxel/lattice.h"
#include "ist/voxel/packed_normal.h"

namespace ist {

/// The triangles that intersect each cube of a sequence, ascending.
struct TriangleLists {
  std::vector<std::uint32_t> first;  ///< cube i owns ids[first[i]] … ids[first[i + 1] - 1]
  std::vector<std::uint32_t> ids;

  [[nodiscard]] bool empty() const noexcept { return first.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return first.empty() ? 0 : first.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t cube) const noexcept {
    return {ids.data() + first[cube], ids.data() + first[cube + 1]};
  }
};

/// The surface voxels of a mesh, stored sparsely: the closed cubes that intersect a triangle.
struct VoxelSet {
  Lattice lattice;
  std::vector<std::uint64_t> codes;   ///< Morton codes, ascending
  std::vector<PackedNormal> normals;  ///< one a voxel
  TriangleLists triangles;            ///< one list a voxel; empty without keep_triangles
};

}  // namespace ist
