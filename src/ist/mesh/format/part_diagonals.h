#pragma once

#include <cstdint>
#include <span>

#include "ist/mesh/mesh.h"

namespace ist {

/// Cuts polygons anew if a diagonal of theirs is an edge of another polygon's triangles too. Two
/// quads that share opposite corners may have the same diagonal. Then four triangles meet in it,
/// and a closed surface has a doubled triangle or no inside. Most polygons have another diagonal.
///
/// @param polygons of each: the number of its corners n, and its corners as vertices of the mesh
/// @param mesh its triangles are n - 2 of each polygon, in order; they keep that order
/// Cost: O(t log t) for t triangles.
void part_diagonals(std::span<const std::uint32_t> polygons, TriangleMesh& mesh);

}  // namespace ist
